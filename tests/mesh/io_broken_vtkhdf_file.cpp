/// VTKHDF files with one thing wrong each, made with HDF5 itself.

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "mesh/io/hdf5_handle.h"
#include "mesh/io/readers.h"
#include "tests/mesh/io_support.h"

namespace rhexis::mesh::test {
namespace {

using io::Hdf5Handle;

struct Dataset {
  std::vector<hsize_t> size;
  std::vector<double> values;
  hid_t type = H5T_STD_I64LE;
};

/// One tet, as a table that tests change before it is written.
struct Content {
  std::string type = "UnstructuredGrid";
  std::vector<std::int64_t> version{1, 0};
  std::map<std::string, Dataset> datasets{{"NumberOfPoints", {{1}, {4}}},
                                          {"NumberOfCells", {{1}, {1}}},
                                          {"NumberOfConnectivityIds", {{1}, {4}}},
                                          {"Points", {{4, 3}, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, H5T_IEEE_F64LE}},
                                          {"Connectivity", {{4}, {0, 1, 2, 3}}},
                                          {"Offsets", {{2}, {0, 4}}},
                                          {"Types", {{1}, {10}, H5T_STD_U8LE}},
                                          {"PointData/t", {{4}, {1, 2, 3, 4}, H5T_IEEE_F32LE}},
                                          {"CellData/s", {{1, 6}, {1, 2, 3, 4, 5, 6}, H5T_IEEE_F64BE}}};
  std::function<void(hid_t root)> extra = [](hid_t) {};
};

std::string image_of(const Content& content, const char* root_name = "VTKHDF") {
  const Hdf5Handle file = io::open_in_memory({});
  {
    const Hdf5Handle root(H5Gcreate2(file, root_name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links, 1);
    for (const auto& [name, data] : content.datasets) {
      const Hdf5Handle space(H5Screate_simple(static_cast<int>(data.size.size()), data.size.data(), nullptr), H5Sclose);
      const Hdf5Handle made(H5Dcreate2(root, name.c_str(), data.type, space, links, H5P_DEFAULT, H5P_DEFAULT),
                            H5Dclose);
      if (!data.values.empty()) H5Dwrite(made, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.values.data());
    }
    const hsize_t length = content.version.size();
    const Hdf5Handle list(H5Screate_simple(1, &length, nullptr), H5Sclose);
    const Hdf5Handle version(H5Acreate2(root, "Version", H5T_STD_I64LE, list, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    H5Awrite(version, H5T_NATIVE_INT64, content.version.data());
    if (!content.type.empty()) {
      const Hdf5Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
      H5Tset_size(text, content.type.size());
      const Hdf5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
      const Hdf5Handle type(H5Acreate2(root, "Type", text, scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
      H5Awrite(type, text, content.type.data());
    }
    content.extra(root);
  }
  H5Fflush(file, H5F_SCOPE_GLOBAL);
  std::string image(static_cast<std::size_t>(H5Fget_file_image(file, nullptr, 0)), '\0');
  H5Fget_file_image(file, image.data(), image.size());
  return image;
}

std::string message_of(const Content& content, const char* root = "VTKHDF") {
  const auto read = io::parse_vtkhdf(image_of(content, root), "a.vtkhdf");
  return read ? "no error" : read.error().message();
}

/// The message when one dataset is another; one without a size is left out.
std::string message_with(const std::string& name, Dataset data) {
  Content content;
  if (data.size.empty())
    content.datasets.erase(name);
  else
    content.datasets[name] = std::move(data);
  return message_of(content);
}

TEST(IoBrokenVtkHdf, TheUnbrokenOneReads) {
  const auto read = io::parse_vtkhdf(image_of(Content{}), "a.vtkhdf");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->mesh.tet_count(), 1U);
  ASSERT_EQ(read->fields.size(), 2U);
  EXPECT_EQ(read->fields[0].values, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(read->fields[1].components, 6);
  EXPECT_TRUE(read->notes.empty());
}

TEST(IoBrokenVtkHdf, Head) {
  EXPECT_EQ(message_of(Content{}, "VTK"), "a.vtkhdf: it holds no group 'VTKHDF' (a VTKHDF file keeps its mesh there)");
  Content content;
  content.type = "ImageData";
  EXPECT_EQ(message_of(content),
            "a.vtkhdf: it holds a VTKHDF file of the type 'ImageData' (save it as UnstructuredGrid)");
  content.type = "";
  EXPECT_EQ(message_of(content), "a.vtkhdf: attribute 'Type' is missing");
  content.type = std::string(300, 'x');
  EXPECT_EQ(message_of(content), "a.vtkhdf: attribute 'Type' has 300 letters (256 at most)");
  content = {};
  content.version = {7, 0};
  EXPECT_EQ(message_of(content), "a.vtkhdf: VTKHDF version 7 is not read (1 or 2)");
  content = {};
  content.datasets["Steps/Values"] = {{1}, {0}};
  EXPECT_EQ(message_of(content), "a.vtkhdf: it holds time steps (save one step to a file of its own)");
}

TEST(IoBrokenVtkHdf, Counts) {
  EXPECT_EQ(message_with("NumberOfPoints", {{2}, {2, 2}}),
            "a.vtkhdf: NumberOfPoints lists 2 parts (merge the parts before saving, and save one time step)");
  EXPECT_EQ(message_with("NumberOfPoints", {{1}, {5}}), "a.vtkhdf: Points holds 12 values where 15 should be");
  EXPECT_EQ(message_with("NumberOfCells", {{1}, {-1}}), "a.vtkhdf: NumberOfCells is -1");
  EXPECT_EQ(message_with("NumberOfCells", {{1}, {5e9}}),
            "a.vtkhdf: 5000000000 NumberOfCells are more than 2147483647 can be counted (cut the mesh)");
  EXPECT_EQ(message_with("NumberOfConnectivityIds", {{1}, {8}}),
            "a.vtkhdf: Connectivity holds 4 values where 8 should be");
  EXPECT_EQ(message_with("NumberOfConnectivityIds", {}), "a.vtkhdf: dataset 'NumberOfConnectivityIds' is missing");
}

TEST(IoBrokenVtkHdf, Arrays) {
  EXPECT_EQ(message_with("Points", {}), "a.vtkhdf: dataset 'Points' is missing");
  EXPECT_EQ(message_with("Points", {{12}, std::vector<double>(12), H5T_IEEE_F64LE}),
            "a.vtkhdf: Points has 1 columns (it should have 3)");
  EXPECT_EQ(message_with("Points", {{2, 2, 3}, std::vector<double>(12), H5T_IEEE_F64LE}),
            "a.vtkhdf: dataset 'Points' has 3 dimensions (1 or 2)");
  EXPECT_EQ(message_with("Points", {{4, 3}, {0, 0, 0, 1, 0, 0, 0, std::nan(""), 0, 0, 0, 1}, H5T_IEEE_F64LE}),
            "a.vtkhdf: point 2 lies at (0, nan, 0) (coordinates have to be finite)");
  EXPECT_EQ(message_with("Connectivity", {{4}, {0, 1, 2, 4}}), "a.vtkhdf: cell 0 names point 4, the points are 0 to 3");
  EXPECT_EQ(message_with("Connectivity", {{4}, {0, 1, 2, 3}, H5T_IEEE_F64LE}),
            "a.vtkhdf: dataset 'Connectivity' does not hold whole numbers");
  EXPECT_EQ(message_with("Offsets", {{1}, {4}}), "a.vtkhdf: Offsets holds 1 values where 2 should be");
  EXPECT_EQ(message_with("Offsets", {{2}, {1, 4}}), "a.vtkhdf: Offsets starts with 1 (it should be 0)");
  EXPECT_EQ(message_with("Offsets", {{2}, {0, 9}}),
            "a.vtkhdf: cell 0 ends at entry 9 of the connectivity, which should lie from 0 to 4");
  EXPECT_EQ(message_with("Offsets", {{2}, {0, -4}}),
            "a.vtkhdf: cell 0 ends at entry -4 of the connectivity, which should lie from 0 to 4");
  EXPECT_EQ(message_with("Types", {{1}, {24}}),
            "a.vtkhdf: cell 0 is a second-order tetrahedron (save the mesh with elements of first order)");
  EXPECT_EQ(message_with("PointData/t", {{3}, {1, 2, 3}, H5T_IEEE_F64LE}),
            "a.vtkhdf: array 't' holds 3 values where 4 should be");
  // Nothing is stored of these values, but they would have to be made.
  EXPECT_EQ(message_with("PointData/t", {{std::uint64_t{1} << 60, 16}, {}, H5T_IEEE_F64LE}),
            "a.vtkhdf: dataset 't' promises 1152921504606846976 times 16 values, far more than a file of its size "
            "should hold "
            "(the file may be cut short or damaged)");
}

TEST(IoBrokenVtkHdf, NothingOutsideOfTheFileIsRead) {
  Content content;
  content.datasets.erase("Points");
  content.extra = [](hid_t root) {
    H5Lcreate_external("/etc/passwd", "/Points", root, "Points", H5P_DEFAULT, H5P_DEFAULT);
  };
  EXPECT_EQ(message_of(content), "a.vtkhdf: dataset 'Points' is not a dataset of this file");
  content.extra = [](hid_t root) {
    const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_external(properties, "/etc/passwd", 0, 96);
    const hsize_t size[2] = {4, 3};
    const Hdf5Handle space(H5Screate_simple(2, size, nullptr), H5Sclose);
    const Hdf5Handle data(H5Dcreate2(root, "Points", H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                          H5Dclose);
  };
  EXPECT_EQ(
      message_of(content),
      "a.vtkhdf: dataset 'Points' is stored in a way that is not read (write it contiguous, or chunked with gzip)");
}

TEST(IoBrokenVtkHdf, CutShort) {
  const std::string image = image_of(Content{});
  for (std::size_t length = 0; length < image.size(); length += 61) {
    EXPECT_FALSE(io::parse_vtkhdf(image.substr(0, length), "a.vtkhdf")) << length;
  }
}

TEST(IoBrokenVtkHdf, ArraysOfOtherTypesAreLeftOut) {
  Content content;
  content.extra = [](hid_t root) {
    const Hdf5Handle data(H5Gopen2(root, "PointData", H5P_DEFAULT), H5Gclose);
    const Hdf5Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
    const Hdf5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle made(H5Dcreate2(data, "words", text, scalar, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  };
  const auto read = io::parse_vtkhdf(image_of(content), "a.vtkhdf");
  ASSERT_TRUE(read) << read.error().message();
  EXPECT_EQ(read->notes, std::vector<std::string>{"array 'words' left out: it is not an array of plain numbers"});
}

}  // namespace
}  // namespace rhexis::mesh::test
