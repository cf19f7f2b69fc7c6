/// The parts that readers are made of, and what MSH groups become.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include "mesh/io/base64.h"
#include "mesh/io/cursor.h"
#include "mesh/io/gzip.h"
#include "mesh/io/numbers.h"
#include "mesh/io/readers.h"
#include "tests/mesh/io_support.h"

namespace rhexis::mesh::test {
namespace {

TEST(IoBase64, KnownAnswers) {
  // RFC 4648, section 10.
  const std::vector<std::pair<std::string, std::string>> known{{"f", "Zg=="},         {"fo", "Zm8="},
                                                               {"foo", "Zm9v"},       {"foob", "Zm9vYg=="},
                                                               {"fooba", "Zm9vYmE="}, {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, encoded] : known) {
    EXPECT_EQ(io::base64_encode(plain), encoded);
    EXPECT_EQ(io::Base64Reader(encoded).read(plain.size()), plain);
  }
}

TEST(IoBase64, ReadsAcrossPaddingBlanksAndPieces) {
  io::Base64Reader reader(" Zg==\nZm8=  Zm9v Ym\nFy ");
  EXPECT_EQ(reader.read(2), "ff");
  EXPECT_EQ(reader.read(0), "");
  EXPECT_EQ(reader.read(3), "ofo");
  EXPECT_EQ(reader.read(4), "obar");
  EXPECT_THROW(reader.read(1), io::ReadFailure);
}

TEST(IoGzip, RoundTripAndMembers) {
  std::string text;
  for (int i = 0; i < 100000; ++i) text += std::to_string(i * 7919 % 1000);
  EXPECT_EQ(io::gunzip(io::gzip(text)), text);
  EXPECT_EQ(io::gunzip(io::gzip("one ") + io::gzip("two")), "one two");
  EXPECT_EQ(io::gunzip(io::gzip("")), "");
  EXPECT_EQ(io::gunzip(io::gzip("x") + "rubbish behind"), "x");
}

TEST(IoGzip, BombIsRefused) {
  const std::string bomb = io::gzip(std::string(std::size_t{100} << 20, ' '));
  EXPECT_LT(bomb.size(), 110000U);
  const auto read = io::parse_mesh(bomb, "bomb.msh.gz");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message(),
            "bomb.msh.gz: it unpacks to more than 70 MiB (unpack it by hand if it can be trusted)");
  EXPECT_EQ(io::unpacked_limit(1), (std::size_t{64} << 20) + 64);
  EXPECT_EQ(io::unpacked_limit(std::size_t{1} << 40), std::size_t{1} << 30);
}

TEST(IoCursor, NumbersAreExactAndStrict) {
  io::Cursor cursor("+1 -0.1 1e-400 4.9e-324 1e400 nan +0.5\n+ 1.0.0");
  EXPECT_EQ(cursor.number("x"), 1.0);
  EXPECT_EQ(cursor.number("x"), -0.1);
  EXPECT_EQ(cursor.number("x"), 0.0);
  EXPECT_EQ(cursor.number("x"), 4.9e-324);
  EXPECT_EQ(cursor.number("x"), INFINITY);
  EXPECT_TRUE(std::isnan(cursor.number("x")));
  EXPECT_EQ(cursor.number("x"), 0.5);
  EXPECT_EQ(cursor.line(), 1);
  EXPECT_THROW(cursor.number("x"), io::ReadFailure);
  EXPECT_EQ(cursor.line(), 2);
  EXPECT_THROW(cursor.number("x"), io::ReadFailure);
}

TEST(IoCursor, LinesOfValuesAreFoundAgain) {
  io::Cursor cursor("\n\n1 2\n\n3\n4 5\n", 10);
  const io::Integers numbers = io::read_text<std::int64_t>(cursor, std::nullopt, "x");
  EXPECT_THAT(numbers.values, ::testing::ElementsAre(1, 2, 3, 4, 5));
  EXPECT_EQ(numbers.line_of(0), 12);
  EXPECT_EQ(numbers.line_of(2), 14);
  EXPECT_EQ(numbers.line_of(4), 15);
}

TEST(IoNumbers, DecodesEveryTypeInBothOrders) {
  using io::Scalar;
  const std::string bytes("\x01\x02\x03\x04\x05\x06\x07\xff", 8);
  EXPECT_THAT(io::decode<std::int64_t>(bytes.substr(6), Scalar::int8, false), ::testing::ElementsAre(7, -1));
  EXPECT_THAT(io::decode<std::int64_t>(bytes.substr(6), Scalar::uint8, true), ::testing::ElementsAre(7, 255));
  EXPECT_THAT(io::decode<std::int64_t>(bytes.substr(6), Scalar::int16, false), ::testing::ElementsAre(-249));
  EXPECT_THAT(io::decode<std::int64_t>(bytes.substr(6), Scalar::uint16, false), ::testing::ElementsAre(0xff07));
  EXPECT_THAT(io::decode<std::int64_t>(bytes.substr(6), Scalar::uint16, true), ::testing::ElementsAre(0x07ff));
  EXPECT_THAT(io::decode<std::int64_t>(bytes, Scalar::int32, true), ::testing::ElementsAre(0x01020304, 0x050607ff));
  EXPECT_THAT(io::decode<std::int64_t>(bytes, Scalar::uint32, false), ::testing::ElementsAre(0x04030201, 0xff070605));
  EXPECT_THAT(io::decode<std::int64_t>(bytes, Scalar::int64, true), ::testing::ElementsAre(0x01020304050607ff));
  EXPECT_THAT(io::decode<double>(std::string("\x3f\x80\0\0", 4), Scalar::float32, true), ::testing::ElementsAre(1.0));
  EXPECT_THAT(io::decode<double>(std::string("\0\0\0\0\0\0\xf0\xbf", 8), Scalar::float64, false),
              ::testing::ElementsAre(-1.0));
}

TEST(IoText, OnlyPrintableUtf8IsPassedOn) {
  EXPECT_EQ(io::printable("Gef\xc3\xa4\xc3\x9f \xe2\x82\xac"), "Gef\xc3\xa4\xc3\x9f \xe2\x82\xac");
  EXPECT_EQ(io::printable("a\x1b[31m\n\x7f\xff\xc3(\xed\xa0\x80\xc0\xaf"),
            "a?[31m"
            "????"
            "(?????");
  EXPECT_EQ(io::in_quotes(std::string(50, 'x')), "'" + std::string(40, 'x') + "...'");
}

/// Two tets on the common face 1 2 3.
std::string two_tets(const std::string& names, const std::string& elements) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" + names +
         "$EndPhysicalNames\n$Nodes\n5\n10 0 0 0\n7 1 0 0\n30 0 1 0\n40 0 0 1\n50 1 1 1\n$EndNodes\n$Elements\n" +
         elements + "$EndElements\n";
}
constexpr const char* kTets = "8 4 2 0 1 10 7 30 40\n9 4 2 0 1 7 30 40 50\n";

TEST(IoGroups, InnerTrianglesAreNodesOnly) {
  const auto read = io::parse_msh(
      two_tets("1\n2 5 \"wall\"\n", std::string("4\n1 2 2 5 5 7 30 40\n2 2 2 5 5 10 30 7\n") + kTets), "a.msh");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_THAT(read->notes, ::testing::ElementsAre(
                               "1 of 2 triangles of 'wall' are no boundary face of the tets: in its node set only"));
  EXPECT_THAT(read->mesh.node_sets[0].nodes, ::testing::ElementsAre(NodeId(0), NodeId(1), NodeId(2), NodeId(3)));
  EXPECT_THAT(read->mesh.face_sets[0].faces, ::testing::ElementsAre(TetFace{TetId(0), 3}));
}

TEST(IoGroups, OneNameIsOneSet) {
  const auto read = io::parse_msh(
      two_tets("3\n0 1 \"a\"\n2 5 \"a\"\n2 6 \"b\"\n", std::string("4\n1 15 2 1 1 50\n2 2 2 5 5 10 30 7\n") + kTets),
      "a.msh");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_THAT(read->notes, ::testing::ElementsAre(
                               "groups of different dimension share the name 'a': its node set holds the nodes of all",
                               "group 'b' holds no element: left out"));
  ASSERT_EQ(read->mesh.node_sets.size(), 1U);
  EXPECT_THAT(read->mesh.node_sets[0].nodes, ::testing::ElementsAre(NodeId(0), NodeId(1), NodeId(2), NodeId(4)));
  EXPECT_EQ(read->mesh.face_sets[0].faces.size(), 1U);
}

TEST(IoGroups, TetsOfTwoGroupsComeOnceTrueDuplicatesStay) {
  const std::string names = "2\n3 1 \"a\"\n3 2 \"b\"\n";
  const auto shared =
      io::parse_msh(two_tets(names, "3\n1 4 2 1 1 10 7 30 40\n2 4 2 2 1 10 7 30 40\n3 4 2 2 1 7 30 40 50\n"), "a.msh");
  ASSERT_TRUE(shared) << shared.error().message();
  EXPECT_EQ(shared->mesh.tet_count(), 2U);
  EXPECT_EQ(shared->mesh.find_node_set("a")->nodes.size(), 4U);
  EXPECT_EQ(shared->mesh.find_node_set("b")->nodes.size(), 5U);
  const auto doubled =
      io::parse_msh(two_tets(names, "3\n1 4 2 1 1 10 7 30 40\n2 4 2 1 1 10 7 30 40\n3 4 2 2 1 7 30 40 50\n"), "a.msh");
  ASSERT_TRUE(doubled) << doubled.error().message();
  EXPECT_EQ(doubled->mesh.tet_count(), 3U);
}

TEST(IoFiles, WhatIsNoFileIsRefused) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& name) {
    const auto read = read_mesh_file(folder / name);
    return read ? "no error" : read.error().message().substr((folder / "").string().size());
  };
  EXPECT_EQ(message("none.msh"), "none.msh: there is no such file");
  std::filesystem::create_directory(folder / "folder.msh");
  EXPECT_EQ(message("folder.msh"), "folder.msh: it is not a file");
  ASSERT_EQ(::mkfifo((folder / "pipe.msh").c_str(), 0600), 0);
  EXPECT_EQ(message("pipe.msh"), "pipe.msh: it is not a file");
}

}  // namespace
}  // namespace rhexis::mesh::test
