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

# The wire: C++ from the one schema; the page makes its TypeScript from the same file.
find_program(RHEXIS_FLATC flatc REQUIRED)
find_path(RHEXIS_FLATBUFFERS_DIR flatbuffers/flatbuffers.h REQUIRED)
set(RHEXIS_WIRE_DIR ${CMAKE_BINARY_DIR}/generated)
set(RHEXIS_SCHEMA ${CMAKE_SOURCE_DIR}/schema/rhexis.fbs)
add_custom_command(
  OUTPUT ${RHEXIS_WIRE_DIR}/wire/rhexis_generated.h
  COMMAND ${RHEXIS_FLATC} --cpp --gen-object-api --scoped-enums -o ${RHEXIS_WIRE_DIR}/wire ${RHEXIS_SCHEMA}
  DEPENDS ${RHEXIS_SCHEMA})
add_custom_target(rhexis_wire_header DEPENDS ${RHEXIS_WIRE_DIR}/wire/rhexis_generated.h)
add_library(rhexis_wire_schema INTERFACE)
add_dependencies(rhexis_wire_schema rhexis_wire_header)
target_include_directories(rhexis_wire_schema SYSTEM INTERFACE ${RHEXIS_WIRE_DIR} ${RHEXIS_FLATBUFFERS_DIR})

# HTTP and WebSocket: Boost.Beast and Asio, headers alone. 1.74's Asio does not compile as C++20 with gcc 12.
find_package(Boost 1.81 REQUIRED)
add_library(rhexis_beast INTERFACE)
target_include_directories(rhexis_beast SYSTEM INTERFACE ${Boost_INCLUDE_DIRS})
target_link_libraries(rhexis_beast INTERFACE Threads::Threads)
# ThreadSanitizer does not see Asio's fences, and needs none of them: what they order is under a mutex too.
target_compile_options(rhexis_beast INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-tsan>)
