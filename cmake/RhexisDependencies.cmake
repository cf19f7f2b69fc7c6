# Every library comes from Debian bookworm; docs/dependencies.md says what each is for and its licence.
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(Eigen3 3.4 REQUIRED)
find_package(TBB REQUIRED)
find_package(ZLIB REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)

find_package(pugixml REQUIRED)

# Headers alone.
find_path(RHEXIS_EXPECTED_DIR tl/expected.hpp REQUIRED)
add_library(rhexis_expected INTERFACE)
target_include_directories(rhexis_expected SYSTEM INTERFACE ${RHEXIS_EXPECTED_DIR})
find_path(RHEXIS_TOML_DIR toml++/toml.h REQUIRED)
add_library(rhexis_tomlplusplus INTERFACE)
target_include_directories(rhexis_tomlplusplus SYSTEM INTERFACE ${RHEXIS_TOML_DIR})

# BLAS: OpenBLAS, one thread (parallelism is ours, and bits must not depend on it).
find_library(RHEXIS_OPENBLAS openblas REQUIRED)
add_library(rhexis_blas INTERFACE)
target_link_libraries(rhexis_blas INTERFACE ${RHEXIS_OPENBLAS})

# CHOLMOD with METIS.
find_path(RHEXIS_CHOLMOD_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(RHEXIS_CHOLMOD cholmod REQUIRED)
add_library(rhexis_cholmod INTERFACE)
target_include_directories(rhexis_cholmod SYSTEM INTERFACE ${RHEXIS_CHOLMOD_DIR})
target_link_libraries(rhexis_cholmod INTERFACE ${RHEXIS_CHOLMOD})
if(RHEXIS_CHOLMOD_GPL)
  target_compile_definitions(rhexis_cholmod INTERFACE RHEXIS_CHOLMOD_GPL)
endif()

# MUMPS, the sequential build; never in one process with MPI.
find_path(RHEXIS_MUMPS_DIR dmumps_c.h REQUIRED)
find_library(RHEXIS_MUMPS dmumps_seq REQUIRED)
add_library(rhexis_mumps INTERFACE)
target_include_directories(rhexis_mumps SYSTEM INTERFACE ${RHEXIS_MUMPS_DIR})
target_link_libraries(rhexis_mumps INTERFACE ${RHEXIS_MUMPS})

# HDF5, the serial C library.
set(HDF5_PREFER_PARALLEL OFF)
find_package(HDF5 REQUIRED COMPONENTS C)
add_library(rhexis_hdf5 INTERFACE)
target_include_directories(rhexis_hdf5 SYSTEM INTERFACE ${HDF5_C_INCLUDE_DIRS})
target_link_libraries(rhexis_hdf5 INTERFACE ${HDF5_C_LIBRARIES})
