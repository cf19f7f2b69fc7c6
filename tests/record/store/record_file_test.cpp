// The file of a record: what is written comes back, the same record is the same bytes, and what is broken is refused.

#include <gmock/gmock.h>

#include <filesystem>
#include <functional>

#include "mesh/io/hdf5_scalars.h"
#include "record/store/record_reader.h"
#include "record/store/record_writer.h"
#include "tests/record/store/some_record.h"
#include "tests/support/run_command.h"

namespace rhexis::record::store {
namespace {

namespace fs = std::filesystem;
using mesh::io::Hdf5Handle;
using mesh::io::stored_type;
using test::SomeRecord;
using testing::HasSubstr;

Parameters small() {
  Parameters out;
  out.advances = 1;
  out.directions = 3;
  out.lengths = {0.02, 0.03};
  out.pull_directions = 4;
  return out;
}

void write(const fs::path& path, const SomeRecord& record) {
  Expected<RecordWriter> writer = RecordWriter::create(path, record.head);
  ASSERT_TRUE(writer) << writer.error().message();
  for (const TopologyData& one : record.topologies) ASSERT_TRUE(writer->append(one));
  ASSERT_TRUE(writer->finish());
}

class RecordFileForms : public testing::TestWithParam<std::tuple<bool, bool>> {};

TEST_P(RecordFileForms, ComesBackAsItWas) {
  const auto [single_precision, has_loads] = GetParam();
  const SomeRecord record = test::some_record(small(), single_precision, has_loads);
  const fs::path path = rhexis::test::fresh_folder("record") / "some.h5";
  write(path, record);
  const Expected<RecordFile> file = RecordFile::open(path);
  ASSERT_TRUE(file) << file.error().message();
  EXPECT_TRUE(file->head() == record.head);
  ASSERT_EQ(file->topologies(), 7);
  for (int k = 0; k < 7; ++k) {
    const Expected<TopologyData> data = file->read_topology(k);
    ASSERT_TRUE(data) << data.error().message();
    EXPECT_TRUE(*data == record.topologies[static_cast<std::size_t>(k)]) << k;
  }
  const Expected<Record> all = file->read_record();
  ASSERT_TRUE(all) << all.error().message();
  EXPECT_EQ(all->stiffness, record.record().stiffness);
  EXPECT_EQ(all->compliance, record.record().compliance);
  EXPECT_EQ(all->in_solve, record.record().in_solve);
  EXPECT_EQ(all->flags, record.record().flags);
  EXPECT_EQ(all->rest, record.record().rest);
  EXPECT_EQ(*fingerprint_of(path), record.head.fingerprint);
}
INSTANTIATE_TEST_SUITE_P(All, RecordFileForms, testing::Combine(testing::Bool(), testing::Bool()));

TEST(RecordFile, TheSameRecordIsTheSameBytes) {
  const SomeRecord record = test::some_record(small(), false, true);
  const fs::path folder = rhexis::test::fresh_folder("record");
  write(folder / "a.h5", record);
  ::sleep(1);  // HDF5 would note the second
  write(folder / "b.h5", record);
  EXPECT_TRUE(rhexis::test::slurp(folder / "a.h5") == rhexis::test::slurp(folder / "b.h5"));
  const double bytes = bytes_of_record(record.head, 7);
  EXPECT_LT(bytes, static_cast<double>(fs::file_size(folder / "a.h5")));
}

std::string refusal(const fs::path& path) {
  const Expected<RecordFile> file = RecordFile::open(path);
  if (!file) return file.error().message();
  if (const Expected<Record> record = file->read_record(); !record) return record.error().message();
  for (int k = 0; k < file->topologies(); ++k) {
    if (const Expected<TopologyData> data = file->read_topology(k); !data) return data.error().message();
  }
  return "taken";
}

TEST(RecordFile, RefusesWhatIsNoRecord) {
  const fs::path folder = rhexis::test::fresh_folder("record");
  EXPECT_THAT(refusal(folder / "none.h5"), HasSubstr("there is no such file"));
  EXPECT_THAT(refusal(folder), HasSubstr("not a file"));
  std::ofstream(folder / "text.h5") << "not HDF5 at all";
  EXPECT_THAT(refusal(folder / "text.h5"), HasSubstr("text.h5: not an HDF5 file"));
  {
    const Hdf5Handle other(H5Fcreate((folder / "other.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  }
  EXPECT_THAT(refusal(folder / "other.h5"), HasSubstr("not a record"));
}

TEST(RecordFile, RefusesWhatIsCutShort) {
  const fs::path folder = rhexis::test::fresh_folder("record");
  write(folder / "whole.h5", test::some_record(small(), false, true));
  const std::string whole = rhexis::test::slurp(folder / "whole.h5");
  ASSERT_EQ(refusal(folder / "whole.h5"), "taken");
  for (std::size_t size = 0; size < whole.size(); size += 97) {
    std::ofstream(folder / "cut.h5", std::ios::binary) << whole.substr(0, size);
    EXPECT_NE(refusal(folder / "cut.h5"), "taken") << size << " of " << whole.size();
  }
}

/// Overwrites a dataset of a good file in place.
template <class Value>
void spoil(const fs::path& path, const char* name, std::size_t at, Value value) {
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  const Hdf5Handle data(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
  const Hdf5Handle space(H5Dget_space(data), H5Sclose);
  std::vector<Value> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  ASSERT_GE(H5Dread(data, stored_type<Value>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
  values.at(at) = value;
  ASSERT_GE(H5Dwrite(data, stored_type<Value>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0) << name;
}

TEST(RecordFile, RefusesNumbersThatAreNone) {
  const fs::path folder = rhexis::test::fresh_folder("record");
  const fs::path path = folder / "spoilt.h5";
  const SomeRecord good = test::some_record(small(), false, true);
  const double none = std::nan("");
  const std::vector<std::pair<const char*, std::function<void()>>> ways{
      {"directions", [&] { spoil<double>(path, "parameters/directions", 1, 80.0); }},
      {"lengths", [&] { spoil<double>(path, "parameters/lengths", 1, 0.01); }},
      {"frame", [&] { spoil<double>(path, "parameters/frame", 0, 0.5); }},
      {"nodes", [&] { spoil<double>(path, "mesh/nodes", 3, none); }},
      {"tets", [&] { spoil<std::int32_t>(path, "mesh/tets", 3, 5); }},
      {"points", [&] { spoil<std::int32_t>(path, "grasp/points", 2, -1); }},
      {"edges", [&] { spoil<std::int32_t>(path, "grasp/edges", 1, 3); }},
      {"dof", [&] { spoil<std::int32_t>(path, "operator/dof", 0, 15); }},
      {"start", [&] { spoil<std::int64_t>(path, "operator/start", 1, 40); }},
      {"row", [&] { spoil<std::int32_t>(path, "operator/row", 1, 4); }},
      {"factor", [&] { spoil<double>(path, "operator/factor", 3, none); }},
      {"diagonal", [&] { spoil<double>(path, "operator/factor", 2, 0.0); }},
      {"stiffness", [&] { spoil<double>(path, "topologies/stiffness", 3, HUGE_VAL); }},
      {"compliance", [&] { spoil<double>(path, "topologies/compliance", 3, none); }},
      {"rest", [&] { spoil<double>(path, "topologies/rest", 3, none); }},
      {"moved_start", [&] { spoil<std::int64_t>(path, "edits/moved_start", 3, -1); }},
      {"moved_node", [&] { spoil<std::int32_t>(path, "edits/moved_node", 0, 99); }},
      {"order of moved_node", [&] { spoil<std::int32_t>(path, "edits/moved_node", 2, 1); }},
      {"gone_tet", [&] { spoil<std::int32_t>(path, "edits/gone_tet", 0, 2); }},
  };
  for (const auto& [name, way] : ways) {
    write(path, good);
    ASSERT_EQ(refusal(path), "taken");
    way();
    EXPECT_THAT(refusal(path), HasSubstr("spoilt.h5: ")) << name;
  }
  write(path, good);
  {
    const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    H5Ldelete(file, "topologies/compliance", H5P_DEFAULT);
  }
  EXPECT_THAT(refusal(path), HasSubstr("'topologies/compliance' is not there"));
}

}  // namespace
}  // namespace rhexis::record::store
