/// Broken meshes, each with the exact line that a user sees. The table is the promise: nothing crashes, and every
/// message names the place and what is wrong.

#include <gtest/gtest.h>

#include "mesh/io/gzip.h"
#include "mesh/io/readers.h"
#include "tests/mesh/io_support.h"

namespace rhexis::mesh::test {
namespace {

/// Two tets and a triangle; the numbers at the right are lines.
const std::string kMsh2 =
    "$MeshFormat\n"        // 1
    "2.2 0 8\n"            // 2
    "$EndMeshFormat\n"     // 3
    "$PhysicalNames\n"     // 4
    "2\n"                  // 5
    "2 1 \"base\"\n"       // 6
    "3 2 \"body\"\n"       // 7
    "$EndPhysicalNames\n"  // 8
    "$Nodes\n"             // 9
    "5\n"                  // 10
    "1 0 0 0\n"            // 11
    "2 1 0 0\n"            // 12
    "3 0 1 0\n"            // 13
    "4 0 0 1\n"            // 14
    "5 1 1 1\n"            // 15
    "$EndNodes\n"          // 16
    "$Elements\n"          // 17
    "3\n"                  // 18
    "1 2 2 1 1 1 2 3\n"    // 19
    "2 4 2 2 1 1 2 3 4\n"  // 20
    "3 4 2 2 1 2 3 4 5\n"  // 21
    "$EndElements\n";      // 22

const std::string kMsh4 =
    "$MeshFormat\n"          // 1
    "4.1 0 8\n"              // 2
    "$EndMeshFormat\n"       // 3
    "$Entities\n"            // 4
    "0 0 0 1\n"              // 5
    "1 0 0 0 1 1 1 1 2 0\n"  // 6
    "$EndEntities\n"         // 7
    "$Nodes\n"               // 8
    "1 4 1 4\n"              // 9
    "3 1 0 4\n"              // 10
    "1\n"                    // 11
    "2\n"                    // 12
    "3\n"                    // 13
    "4\n"                    // 14
    "0 0 0\n"                // 15
    "1 0 0\n"                // 16
    "0 1 0\n"                // 17
    "0 0 1\n"                // 18
    "$EndNodes\n"            // 19
    "$Elements\n"            // 20
    "1 1 1 1\n"              // 21
    "3 1 4 1\n"              // 22
    "1 1 2 3 4\n"            // 23
    "$EndElements\n";        // 24

const std::string kVtu =
    "<?xml version=\"1.0\"?>\n"                                                                 // 1
    "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"         // 2
    "<UnstructuredGrid>\n"                                                                      // 3
    "<Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">\n"                                        // 4
    "<Points>\n"                                                                                // 5
    "<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n"  // 6
    "0 0 0  1 0 0\n"                                                                            // 7
    "0 1 0  0 0 1\n"                                                                            // 8
    "</DataArray>\n"                                                                            // 9
    "</Points>\n"                                                                               // 10
    "<Cells>\n"                                                                                 // 11
    "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\n"                       // 12
    "0 1\n"                                                                                     // 13
    "2 3\n"                                                                                     // 14
    "</DataArray>\n"                                                                            // 15
    "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray>\n"               // 16
    "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray>\n"                // 17
    "</Cells>\n"                                                                                // 18
    "<PointData>\n"                                                                             // 19
    "<DataArray type=\"Float64\" Name=\"t\" format=\"ascii\">1 2 3 4</DataArray>\n"             // 20
    "</PointData>\n"                                                                            // 21
    "</Piece>\n"                                                                                // 22
    "</UnstructuredGrid>\n"                                                                     // 23
    "</VTKFile>\n";                                                                             // 24

const std::string kVtk =
    "# vtk DataFile Version 3.0\n"  // 1
    "a tet\n"                       // 2
    "ASCII\n"                       // 3
    "DATASET UNSTRUCTURED_GRID\n"   // 4
    "POINTS 4 double\n"             // 5
    "0 0 0 1 0 0\n"                 // 6
    "0 1 0 0 0 1\n"                 // 7
    "CELLS 1 5\n"                   // 8
    "4 0 1 2 3\n"                   // 9
    "CELL_TYPES 1\n"                // 10
    "10\n"                          // 11
    "POINT_DATA 4\n"                // 12
    "SCALARS t double\n"            // 13
    "LOOKUP_TABLE default\n"        // 14
    "1 2 3 4\n";                    // 15

const std::string kVtk5 =
    "# vtk DataFile Version 5.1\n"  // 1
    "a tet\n"                       // 2
    "ASCII\n"                       // 3
    "DATASET UNSTRUCTURED_GRID\n"   // 4
    "POINTS 4 double\n"             // 5
    "0 0 0 1 0 0\n"                 // 6
    "0 1 0 0 0 1\n"                 // 7
    "CELLS 2 4\n"                   // 8
    "OFFSETS vtktypeint64\n"        // 9
    "0 4\n"                         // 10
    "CONNECTIVITY vtktypeint64\n"   // 11
    "0 1 2 3\n"                     // 12
    "CELL_TYPES 1\n"                // 13
    "10\n";                         // 14

/// `text` with the first `from` replaced; that has to be there.
std::string edited(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return at == text.npos ? text : text.replace(at, from.size(), to);
}

std::string cut_behind(const std::string& text, const std::string& last) {
  return text.substr(0, text.find(last) + last.size());
}

struct Broken {
  std::string file;
  std::string bytes;
  std::string message;
};

void expect_messages(const std::vector<Broken>& table) {
  for (const Broken& broken : table) {
    const auto read = io::parse_mesh(broken.bytes, broken.file);
    EXPECT_EQ(read ? "no error" : read.error().message(), broken.message);
  }
}

TEST(IoBroken, TheUnbrokenOnesRead) {
  for (const auto& [file, text] : std::vector<std::pair<std::string, std::string>>{
           {"a.msh", kMsh2}, {"b.msh", kMsh4}, {"c.vtu", kVtu}, {"d.vtk", kVtk}, {"e.vtk", kVtk5}}) {
    const auto read = io::parse_mesh(text, file);
    ASSERT_TRUE(read) << read.error().message();
    EXPECT_EQ(read->mesh.tet_count(), file == "a.msh" ? 2U : 1U);
    EXPECT_TRUE(read->notes.empty());
    const auto zipped = io::parse_mesh(io::gzip(text), file + ".gz");
    ASSERT_TRUE(zipped) << zipped.error().message();
    EXPECT_EQ(zipped->mesh.nodes, read->mesh.nodes);
  }
}

TEST(IoBroken, Msh2) {
  expect_messages({
      {"a.msh", "", "a.msh:1: it is empty"},
      {"a.msh", "solid box\n", "a.msh:1: it starts with 'solid', a Gmsh file with '$MeshFormat'"},
      {"a.msh", "$NOD\n4\n",
       "a.msh:1: it starts with '$NOD', a Gmsh file with '$MeshFormat' (MSH 1 is not read, save as 4.1 or 2.2)"},
      {"a.msh", edited(kMsh2, "2.2 0 8", "3.0 0 8"), "a.msh:2: MSH version '3.0' is not read (save as 4.1 or 2.2)"},
      {"a.msh", edited(kMsh2, "2.2 0 8", "2.2 0 4"), "a.msh:2: a data size of 4 is not read (it should be 8)"},
      {"a.msh", edited(kMsh2, "2.2 0 8", "2.2 7 8"), "a.msh:2: file type 7 is not known (0 for text, 1 for binary)"},
      {"a.msh", edited(kMsh2, "2.2 0 8", "2.2 0"), "a.msh:2: the line ends where the data size should be"},
      {"a.msh", edited(kMsh2, "\"base\"", "base"), "a.msh:6: a name in quotes should follow, not 'base'"},
      {"a.msh", edited(kMsh2, "2 1 \"base\"", "4 1 \"base\""), "a.msh:6: a group of dimension 4 (0 to 3)"},
      {"a.msh", edited(kMsh2, "$Nodes\n5\n", "$Nodes\n6\n"),
       "a.msh:16: '$EndNodes' stands where a node should be (is the count right?)"},
      {"a.msh", edited(kMsh2, "$Nodes\n5\n", "$Nodes\n4\n"),
       "a.msh:15: section $Nodes goes on with '5' where it should end (is its count right?)"},
      {"a.msh", edited(kMsh2, "$Nodes\n5\n", "$Nodes\n-1\n"), "a.msh:10: the number of nodes is -1"},
      {"a.msh", edited(kMsh2, "$Nodes\n5\n", "$Nodes\n2000000000\n"),
       "a.msh:10: 2000000000 nodes are promised, the rest of the file has room for 17 (it may be cut short)"},
      {"a.msh", edited(kMsh2, "$Nodes\n5\n", "$Nodes\n99999999999999999999\n"),
       "a.msh:10: the number of nodes '99999999999999999999' is out of range"},
      {"a.msh", edited(kMsh2, "3 0 1 0\n", "3 0 1\n"), "a.msh:13: the line ends where a coordinate should be"},
      {"a.msh", edited(kMsh2, "3 0 1 0\n", "3 0 1 0 9\n"), "a.msh:13: a node is followed by '9' on its line"},
      {"a.msh", edited(kMsh2, "3 0 1 0\n", "3 0 l 0\n"), "a.msh:13: a coordinate should be a number, not 'l'"},
      {"a.msh", edited(kMsh2, "3 0 1 0\n", "3 0 1,5 0\n"), "a.msh:13: a coordinate should be a number, not '1,5'"},
      {"a.msh", edited(kMsh2, "3 0 1 0\n", "3 0 nan 0\n"),
       "a.msh:13: node 3 lies at (0, nan, 0) (coordinates have to be finite)"},
      {"a.msh", edited(kMsh2, "3 0 1 0\n", "3 0 1e999 0\n"),
       "a.msh:13: node 3 lies at (0, inf, 0) (coordinates have to be finite)"},
      {"a.msh", edited(kMsh2, "3 0 1 0\n", "2 0 1 0\n"), "a.msh:13: node 2 is there twice (number every node once)"},
      {"a.msh", edited(kMsh2, "2 4 2 2 1 1 2 3 4", "2 4 2 2 1 1 2 3 6"),
       "a.msh:20: element 2 names node 6, which does not exist"},
      {"a.msh", edited(kMsh2, "2 4 2 2 1 1 2 3 4", "2 4 2 2 1 1 2 3"),
       "a.msh:20: the line ends where a node of the element should be"},
      {"a.msh", edited(kMsh2, "2 4 2 2 1 1 2 3 4", "2 4 2 2 1 1 2 3 4 5"),
       "a.msh:20: element 2 is followed by '5' on its line"},
      {"a.msh", edited(kMsh2, "2 4 2 2 1 1 2 3 4", "2 99 2 2 1 1 2 3 4"), "a.msh:20: element type 99 is not known"},
      {"a.msh", edited(kMsh2, "2 4 2 2 1 1 2 3 4", "2 5 2 2 1 1 2 3 4 5 1 2 3"),
       "a.msh:20: element 2: hexahedra are not read (mesh the volume with linear tetrahedra)"},
      {"a.msh", edited(kMsh2, "2 4 2 2 1 1 2 3 4", "2 11 2 2 1 1 2 3 4 5 1 2 3 4 5"),
       "a.msh:20: element 2: second-order tetrahedra are not read (mesh with elements of first order: gmsh -order 1)"},
      {"a.msh", edited(kMsh2, "2 4 2 2 1 1 2 3 4", "2 4 -1 2 1 1 2 3 4"), "a.msh:20: the number of tags is -1"},
      {"a.msh", edited(kMsh2, "$Elements\n3\n", "$Elements\n2\n"),
       "a.msh:21: section $Elements goes on with '3' where it should end (is its count right?)"},
      {"a.msh", edited(kMsh2, "$Elements\n3\n", "$Elements\n4\n"),
       "a.msh:22: '$EndElements' stands where an element should be (is the count right?)"},
      {"a.msh", cut_behind(kMsh2, "2 4 2 2 1 1 2"),
       "a.msh:20: the file ends where a node of the element should be (it may be cut short)"},
      {"a.msh", cut_behind(kMsh2, "$EndNodes\n"),
       "a.msh:16: it holds no section $Elements (the file may be cut short)"},
      {"a.msh", cut_behind(kMsh2, "4 0 0 1\n"),
       "a.msh:14: the file ends where the number of a node should be (it may be cut short)"},
      {"a.msh", edited(kMsh2, "$Nodes", "$Comments"),
       "a.msh:9: section $Comments has no end (the file may be cut short)"},
      {"a.msh", edited(edited(kMsh2, "$Nodes", "$Comments"), "$EndNodes", "$EndComments"),
       "a.msh:17: $Elements stands before $Nodes"},
      {"a.msh", edited(kMsh2, "$EndPhysicalNames\n", "$EndPhysicalNames\nhello\n"),
       "a.msh:9: a section should start here, not 'hello'"},
      {"a.msh", kMsh2 + "$Nodes\n0\n$EndNodes\n", "a.msh:23: section $Nodes is there twice"},
      {"a.msh", cut_behind(kMsh2, "$EndNodes\n") + "$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n",
       "a.msh: it holds no tetrahedron (mesh the volume, and save linear tetrahedra)"},
  });
}

TEST(IoBroken, Msh2Binary) {
  const auto bytes = [](auto... values) {
    std::string out;
    (out.append(reinterpret_cast<const char*>(&values), sizeof(values)), ...);
    return out;
  };
  const std::string head = "$MeshFormat\n2.2 1 8\n" + bytes(1) + "\n$EndMeshFormat\n";
  const std::string nodes =
      "$Nodes\n4\n" + bytes(1, 0., 0., 0., 2, 1., 0., 0., 3, 0., 1., 0., 4, 0., 0., 1.) + "\n$EndNodes\n";
  const std::string good = head + nodes + "$Elements\n1\n" + bytes(4, 1, 2, 1, 0, 1, 1, 2, 3, 4) + "\n$EndElements\n";
  ASSERT_TRUE(io::parse_msh(good, "good.msh"));
  expect_messages({
      {"a.msh", edited(head, bytes(1), bytes(7)), "a.msh: the byte order mark is damaged (it should be the integer 1)"},
      {"a.msh", head.substr(0, 22),
       "a.msh: the file ends where the byte order mark should be: 2 bytes are left of 4 (it may be cut short)"},
      {"a.msh", head + edited(nodes, "\n4\n", "\n900000\n"),
       "a.msh: 900000 nodes are promised, the rest of the file has room for 5 (it may be cut short)"},
      {"a.msh", head + edited(nodes, bytes(3, 0., 1.), bytes(3, 0., std::nan(""))),
       "a.msh: node 3 lies at (0, nan, 0) (coordinates have to be finite)"},
      {"a.msh", head + edited(nodes, bytes(3, 0., 1.), bytes(2, 0., 1.)),
       "a.msh: node 2 is there twice (number every node once)"},
      {"a.msh", head + edited(nodes, "\n4\n", "\n3\n"),
       "a.msh: section $Nodes goes on with '" + std::string(28, '?') + "' where it should end (is its count right?)"},
      {"a.msh", good.substr(0, good.size() - 20),
       "a.msh: the file ends where a node of the element should be: 2 bytes are left of 4 (it may be cut short)"},
      {"a.msh", edited(good, bytes(4, 1, 2, 1), bytes(4, 2, 2, 1)), "a.msh: a run of 2 elements after 0 of 1"},
      {"a.msh", edited(good, bytes(4, 1, 2, 1), bytes(4, 1, -2, 1)), "a.msh: the number of tags is -2"},
      {"a.msh", edited(good, bytes(2, 3, 4), bytes(2, 3, 5)), "a.msh: element 1 names node 5, which does not exist"},
  });
}

TEST(IoBroken, Msh4) {
  expect_messages({
      {"a.msh", edited(kMsh4, "4.1", "4.0"), "a.msh:2: MSH version '4.0' is not read (save as 4.1 or 2.2)"},
      {"a.msh", edited(kMsh4, "0 0 0 1\n", "0 0 1\n"), "a.msh:5: the line ends where the number of entities should be"},
      {"a.msh", edited(kMsh4, "0 0 0 1\n", "0 0 1 1\n"),
       "a.msh:7: '$EndEntities' stands where an entity should be (is the count right?)"},
      {"a.msh", edited(kMsh4, "1 0 0 0 1 1 1 1 2 0", "1 0 0 0 1 1 1 90000 2 0"),
       "a.msh:6: 90000 physical tags are promised, the rest of the file has room for 67 (it may be cut short)"},
      {"a.msh", edited(kMsh4, "1 4 1 4\n", "2 4 1 4\n"),
       "a.msh:19: '$EndNodes' stands where the head of a node block should be (is the count right?)"},
      {"a.msh", edited(kMsh4, "1 4 1 4\n", "1 5 1 5\n"), "a.msh:18: the section promises 5 nodes, its blocks hold 4"},
      {"a.msh", edited(kMsh4, "1 4 1 4\n", "1 3 1 5\n"),
       "a.msh:10: the blocks hold more nodes than the 3 of the section"},
      {"a.msh", edited(kMsh4, "3 1 0 4\n", "4 1 0 4\n"), "a.msh:10: the dimension of an entity is 4 (0 to 3)"},
      {"a.msh", edited(kMsh4, "3 1 0 4\n", "3 1 0 3\n"), "a.msh:14: the line ends where a coordinate should be"},
      {"a.msh", edited(kMsh4, "3 1 0 4\n", "3 1 1 4\n"),
       "a.msh:15: the line ends where a parameter of the node should be"},
      {"a.msh", edited(kMsh4, "\n2\n3\n", "\n2\n2\n"), "a.msh:13: node 2 is there twice (number every node once)"},
      {"a.msh", edited(kMsh4, "\n2\n3\n", "\n2\n-3\n"),
       "a.msh:13: the tag of a node is -3 (it should not be negative)"},
      {"a.msh", edited(kMsh4, "0 1 0\n", "0 inf 0\n"),
       "a.msh:17: node 3 lies at (0, inf, 0) (coordinates have to be finite)"},
      {"a.msh", edited(kMsh4, "1 1 1 1\n", "1 2 1 2\n"),
       "a.msh:23: the section promises 2 elements, its blocks hold 1"},
      {"a.msh", edited(kMsh4, "1 1 1 1\n", "1 -1 1 2\n"),
       "a.msh:21: the number of elements is -1 (it should not be negative)"},
      {"a.msh", edited(kMsh4, "3 1 4 1\n", "2 1 4 1\n"),
       "a.msh:22: tetrahedra in an entity of dimension 2 (the block's head is wrong)"},
      {"a.msh", edited(kMsh4, "1 1 2 3 4\n", "1 1 2 3 9\n"), "a.msh:23: element 1 names node 9, which does not exist"},
      {"a.msh", edited(kMsh4, "1 1 2 3 4\n", "1 1 2 3\n"),
       "a.msh:23: the line ends where a node of the element should be"},
      {"a.msh", cut_behind(kMsh4, "0 1 0\n"),
       "a.msh:17: the file ends where a coordinate should be (it may be cut short)"},
  });
}

TEST(IoBroken, Vtu) {
  const std::string packed = edited(kVtu, "byte_order", "compressor=\"vtkZLibDataCompressor\" byte_order");
  std::string appended = edited(edited(kVtu, "ascii\">1 2 3 4</DataArray>", "appended\" offset=\"0\"/>"), "</VTKFile>",
                                "<AppendedData encoding=\"raw\">\n_");
  appended.pop_back();  // the line end behind VTKFile
  expect_messages({
      {"a.vtu", "", "a.vtu:1: it is not well-formed XML: no document element found (the file may be cut short)"},
      {"a.vtu", "<html></html>", "a.vtu:1: it is not a VTK XML file (its outermost element should be VTKFile)"},
      {"a.vtu", cut_behind(kVtu, "0 0 0  1 0 0\n"),
       "a.vtu:7: it is not well-formed XML: start-end tags mismatch (the file may be cut short)"},
      {"a.vtu", edited(kVtu, "</Points>", "</Point>"),
       "a.vtu:10: it is not well-formed XML: start-end tags mismatch (the file may be cut short)"},
      {"a.vtu", edited(kVtu, "UnstructuredGrid", "PolyData"),
       "a.vtu:2: it holds a VTK file of the type 'PolyData' (save it as UnstructuredGrid)"},
      {"a.vtu", edited(kVtu, "LittleEndian", "MiddleEndian"),
       "a.vtu:2: byte_order 'MiddleEndian' is not known (LittleEndian or BigEndian)"},
      {"a.vtu", edited(kVtu, "byte_order", "compressor=\"vtkLZ4DataCompressor\" byte_order"),
       "a.vtu:2: compressor 'vtkLZ4DataCompressor' is not read (vtkZLibDataCompressor or none)"},
      {"a.vtu", edited(kVtu, "byte_order", "header_type=\"UInt16\" byte_order"),
       "a.vtu:2: header_type 'UInt16' is not known (UInt32 or UInt64)"},
      {"a.vtu", edited(kVtu, "NumberOfPoints=\"4\"", "NumberOfPoints=\"5\""),
       "a.vtu:4: the piece promises 5 points and holds 4"},
      {"a.vtu", edited(kVtu, "NumberOfCells=\"1\"", "NumberOfCells=\"2\""),
       "a.vtu:4: the piece promises 2 cells and holds 1"},
      {"a.vtu", edited(kVtu, "</Piece>\n", "</Piece>\n<Piece NumberOfPoints=\"1\" NumberOfCells=\"0\"/>\n"),
       "a.vtu:23: it holds more than one piece (merge the pieces before saving)"},
      {"a.vtu", edited(edited(kVtu, "\"4\"", "\"0\""), "NumberOfCells=\"1\"", ""),
       "a.vtu:3: it holds no piece with points"},
      {"a.vtu", edited(kVtu, "Float64", "Float128"),
       "a.vtu:6: array 'Points' has the type 'Float128' (Int8 to UInt64, Float32 or Float64)"},
      {"a.vtu", edited(kVtu, "NumberOfComponents=\"3\"", "NumberOfComponents=\"2\""),
       "a.vtu:6: points have 2 components (3, also for flat meshes)"},
      {"a.vtu", edited(kVtu, "0 1 0  0 0 1", "0 1 0  0 0"), "a.vtu:7: points hold 11 values, no multiple of 3"},
      {"a.vtu", edited(kVtu, "0 1 0  0 0 1", "0 1 0  0 0 one"),
       "a.vtu:8: a value of Points should be a number, not 'one'"},
      {"a.vtu", edited(kVtu, "0 1 0  0 0 1", "0 1 0  0 0 NaN"),
       "a.vtu:8: point 3 lies at (0, 0, nan) (coordinates have to be finite)"},
      {"a.vtu", edited(kVtu, "2 3\n", "2 4\n"), "a.vtu:14: cell 0 names point 4, the points are 0 to 3"},
      {"a.vtu", edited(kVtu, "2 3\n", "2 -3\n"), "a.vtu:14: cell 0 names point -3, the points are 0 to 3"},
      {"a.vtu", edited(kVtu, "2 3\n", "2\n"),
       "a.vtu:16: cell 0 ends at entry 4 of the connectivity, which should lie from 0 to 3"},
      {"a.vtu", edited(kVtu, "2 3\n", "2 3 3\n"), "a.vtu:13: the connectivity holds 5 entries, the cells use 4"},
      {"a.vtu", edited(kVtu, "2 3\n", "2 3.5\n"),
       "a.vtu:14: a value of connectivity should be a whole number, not '3.5'"},
      {"a.vtu", edited(kVtu, "Int32\" Name=\"connectivity", "Float32\" Name=\"connectivity"),
       "a.vtu:12: array 'connectivity' does not hold whole numbers (Int32 or Int64)"},
      {"a.vtu", edited(kVtu, "ascii\">4<", "ascii\">3<"),
       "a.vtu:16: cell 0 is a tetrahedron with 3 points instead of 4"},
      {"a.vtu", edited(kVtu, "ascii\">4<", "ascii\">4 4<"), "a.vtu:16: offsets holds 2 values where 1 should be"},
      {"a.vtu", edited(kVtu, "ascii\">10<", "ascii\">12<"),
       "a.vtu:17: cell 0 is a hexahedron (split the volume into linear tetrahedra)"},
      {"a.vtu", edited(kVtu, "ascii\">10<", "ascii\">24<"),
       "a.vtu:17: cell 0 is a second-order tetrahedron (save the mesh with elements of first order)"},
      {"a.vtu", edited(kVtu, "ascii\">10<", "ascii\">99<"),
       "a.vtu:17: cell 0 is of VTK's type 99 (split the volume into linear tetrahedra)"},
      {"a.vtu", edited(kVtu, "ascii\">10<", "ascii\">9<"),
       "a.vtu: it holds no tetrahedron, only 1 quadrilaterals and polygons (mesh the volume, and save linear "
       "tetrahedra)"},
      {"a.vtu", edited(kVtu, "Name=\"types\"", "Name=\"kinds\""), "a.vtu:11: Cells holds no array 'types'"},
      {"a.vtu", edited(kVtu, "1 2 3 4", "1 2 3"), "a.vtu:20: array 't' holds 3 values where 4 should be"},
      {"a.vtu", edited(kVtu, "ascii\">1 2 3 4", "hex\">1 2 3 4"),
       "a.vtu:20: array 't': format 'hex' is not known (ascii, binary or appended)"},
      {"a.vtu", edited(kVtu, "ascii\">1 2 3 4", "binary\">IAAAAA=="),
       "a.vtu:20: array 't': 32 bytes are promised, 3 are there (the file may be cut short)"},
      {"a.vtu", edited(kVtu, "ascii\">1 2 3 4", "binary\">IA*AAA=="),
       "a.vtu:20: array 't': base64 data hold '*' where no such letter can be"},
      {"a.vtu", edited(kVtu, "ascii\">1 2 3 4", "binary\">AwAAAAAAAA=="),
       "a.vtu:20: array 't': 3 bytes are no whole number of values of 8 bytes"},
      {"a.vtu", edited(kVtu, "ascii\">1 2 3 4", "appended\" offset=\"7\">"),
       "a.vtu:20: array 't': offset 7 lies outside of the 0 bytes of appended data (the file may be cut short)"},
      {"a.vtu", appended + std::string("\xff\xff\xff\x7f", 4),
       "a.vtu:20: array 't': 2147483647 bytes are promised, 0 are there (the file may be cut short)"},
      {"a.vtu", appended.substr(0, appended.size() - 1),
       "a.vtu:24: AppendedData has no underscore before its data (the file may be cut short)"},
      {"a.vtu", edited(packed, "ascii\">1 2 3 4", "binary\">/////////38AAAAAAAAAAA=="),
       "a.vtu:20: array 't': 4294967295 compressed blocks are promised, more than the data can hold"},
      // One block of 32 bytes in 4 bytes, which are no zlib.
      {"a.vtu", edited(packed, "ascii\">1 2 3 4", "binary\">AQAAACAAAAAAAAAABAAAAA==AAAAAA=="),
       "a.vtu:20: array 't': a block of packed data is damaged (fetch or write the file again)"},
      // One block that promises 3 GiB.
      {"a.vtu", edited(packed, "ascii\">1 2 3 4", "binary\">AQAAAAAAAMAAAAAABAAAAA==AAAAAA=="),
       "a.vtu:20: array 't': compressed blocks of 3221225472 bytes, the last of 0, make no sense"},
  });
}

TEST(IoBroken, Vtk) {
  expect_messages({
      {"a.vtk", "", "a.vtk:1: it is not a legacy VTK file (its first line should be '# vtk DataFile Version ...')"},
      {"a.vtk", "ply\n",
       "a.vtk:1: it is not a legacy VTK file (its first line should be '# vtk DataFile Version ...')"},
      {"a.vtk", edited(kVtk, "3.0", "9.0"), "a.vtk:1: VTK file version '9.0' is not read (1 to 5.1)"},
      {"a.vtk", edited(kVtk, "ASCII", "UTF8"), "a.vtk:3: ASCII or BINARY should stand here, not 'utf8'"},
      {"a.vtk", edited(kVtk, "UNSTRUCTURED_GRID", "POLYDATA"),
       "a.vtk:4: it holds a data set of the kind 'POLYDATA' (save it as UNSTRUCTURED_GRID)"},
      {"a.vtk", edited(kVtk, "POINTS 4 double", "POINTS 4 quad"),
       "a.vtk:5: data type 'quad' is not read (int, float, double, ...)"},
      {"a.vtk", edited(kVtk, "POINTS 4 double", "POINTS 400000 double"),
       "a.vtk:5: 1200000 values of points are promised, the rest of the file has room for 61 (it may be cut short)"},
      {"a.vtk", edited(kVtk, "POINTS 4 double", "POINTS 3 double"), "a.vtk:7: a keyword should stand here, not '0'"},
      {"a.vtk", edited(kVtk, "POINTS 4 double", "POINTS 5 double"),
       "a.vtk:8: a value of points should be a number, not 'CELLS'"},
      {"a.vtk", edited(kVtk, "0 1 0 0 0 1", "0 1 0 0 0 nan"),
       "a.vtk:7: point 3 lies at (0, 0, nan) (coordinates have to be finite)"},
      {"a.vtk", edited(kVtk, "CELLS 1 5", "CELLS 1 4"),
       "a.vtk:9: cell 0 does not fit into the 4 entries of the cells (is the second number of CELLS right?)"},
      {"a.vtk", edited(kVtk, "CELLS 1 5\n4 0 1 2 3", "CELLS 1 6\n4 0 1 2 3 3"),
       "a.vtk:9: 1 cells use 5 of the 6 entries"},
      {"a.vtk", edited(kVtk, "4 0 1 2 3", "4 0 1 2 4"), "a.vtk:9: cell 0 names point 4, the points are 0 to 3"},
      {"a.vtk", edited(kVtk, "4 0 1 2 3", "7 0 1 2 3"),
       "a.vtk:9: cell 0 does not fit into the 5 entries of the cells (is the second number of CELLS right?)"},
      {"a.vtk", edited(kVtk, "CELLS 1 5\n4 0 1 2 3", "CELLS 1 4\n3 0 1 2"),
       "a.vtk:9: cell 0 is a tetrahedron with 3 points instead of 4"},
      {"a.vtk", edited(kVtk, "CELL_TYPES 1\n10", "CELL_TYPES 1\n13"),
       "a.vtk:11: cell 0 is a wedge (split the volume into linear tetrahedra)"},
      {"a.vtk", edited(kVtk, "CELL_TYPES 1\n10", "CELL_TYPES 2\n10 10"), "a.vtk:10: 2 cell types for 1 cells"},
      {"a.vtk", edited(kVtk, "CELLS 1 5\n4 0 1 2 3\n", ""), "a.vtk:8: CELL_TYPES stand before CELLS"},
      {"a.vtk", cut_behind(kVtk, "4 0 1 2 3\n"), "a.vtk:9: it holds no CELLS with CELL_TYPES (it may be cut short)"},
      {"a.vtk", edited(kVtk, "POINT_DATA 4", "POINT_DATA 5"), "a.vtk:12: data for 5 points, there are 4"},
      {"a.vtk", edited(kVtk, "SCALARS", "SCALERS"), "a.vtk:13: a keyword should stand here, not 'SCALERS'"},
      {"a.vtk", edited(kVtk, "1 2 3 4\n", "1 2 3\n"),
       "a.vtk:15: the file ends where a value of array 't' should be (it may be cut short)"},
      {"a.vtk", edited(kVtk, "1 2 3 4\n", "1 2 3 4 5\n"), "a.vtk:15: a keyword should stand here, not '5'"},
      {"a.vtk", edited(edited(kVtk, "ASCII", "BINARY"), "POINTS 4", "POINTS 400"),
       "a.vtk:6: points promises 1200 values, the rest of the file has room for 14 (it may be cut short)"},
      {"a.vtk", edited(kVtk5, "0 4\n", "1 4\n"), "a.vtk:10: OFFSETS should start with 0"},
      {"a.vtk", edited(kVtk5, "0 4\n", "0 5\n"),
       "a.vtk:10: cell 0 ends at entry 5 of the connectivity, which should lie from 0 to 4"},
      {"a.vtk", edited(kVtk5, "OFFSETS", "OFFSET"), "a.vtk:9: OFFSETS should follow CELLS"},
      {"a.vtk", edited(kVtk5, "CONNECTIVITY vtktypeint64\n0 1", "CONNECTIVITY vtktypeint64\n0 8"),
       "a.vtk:12: cell 0 names point 8, the points are 0 to 3"},
      {"a.vtk", edited(kVtk5, "OFFSETS vtktypeint64", "OFFSETS double"),
       "a.vtk:9: OFFSETS does not hold whole numbers (vtktypeint64)"},
  });
}

TEST(IoBroken, Names) {
  expect_messages({
      {"a.stl", "solid",
       "a.stl: a mesh cannot be read from the ending '.stl' (.msh, .vtu, .vtk or .vtkhdf, each also with .gz behind)"},
      {"mesh", "x",
       "mesh: a mesh cannot be read from the ending '' (.msh, .vtu, .vtk or .vtkhdf, each also with .gz behind)"},
      {"a.msh.gz", kMsh2, "a.msh.gz: it is not a gzip file (pack it with gzip, or take .gz off its name)"},
      {"a.msh.gz", io::gzip(kMsh2).substr(0, 60), "a.msh.gz: the packed data end early (it may be cut short)"},
      {"a.stl.gz", io::gzip(kMsh2),
       "a.stl.gz: a mesh cannot be read from the ending '.stl' (.msh, .vtu, .vtk or .vtkhdf, each also with .gz "
       "behind)"},
      {"a.msh.gz", io::gzip(edited(kMsh2, "3 0 1 0\n", "3 0 1\n")),
       "a.msh.gz:13: the line ends where a coordinate should be"},
      {"a.vtkhdf", "", "a.vtkhdf: it is not an HDF5 file"},
      {"a.vtkhdf", kVtu, "a.vtkhdf: it is not an HDF5 file"},
      {"a.vtkhdf", "\x89HDF\r\n\x1a\n and nothing that follows",
       "a.vtkhdf: HDF5 cannot open it (it may be cut short or damaged)"},
  });
  std::string damaged = io::gzip(kMsh2);
  damaged[30] = static_cast<char>(~damaged[30]);
  const auto read = io::parse_mesh(damaged, "a.msh.gz");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message(), "a.msh.gz: the packed data are damaged (fetch or pack the file again)");
}

}  // namespace
}  // namespace rhexis::mesh::test
