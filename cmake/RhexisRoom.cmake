# rhexis_room(<path> [NEEDS rooms...] [USES libraries...]): the library of src/<path>, made of the .cpp files in that
# folder alone (a room inside a room is a room of its own).
#
# Sources named *_avx2.cpp and *_avx512.cpp are compiled for those instruction sets and chosen at run time.
function(rhexis_target_name path out)
  string(REPLACE "/" "_" name ${path})
  set(${out} rhexis_${name} PARENT_SCOPE)
endfunction()

function(rhexis_room path)
  cmake_parse_arguments(ROOM "" "" "NEEDS;USES" ${ARGN})
  rhexis_target_name(${path} target)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${path}/*.cpp)
  add_library(${target} STATIC ${sources})
  target_include_directories(${target} PUBLIC ${CMAKE_SOURCE_DIR}/src)
  foreach(need IN LISTS ROOM_NEEDS)
    rhexis_target_name(${need} needed)
    target_link_libraries(${target} PUBLIC ${needed})
  endforeach()
  target_link_libraries(${target} PUBLIC ${ROOM_USES})
  rhexis_warnings(${target})
  foreach(source IN LISTS sources)
    if(source MATCHES "_avx2\\.cpp$")
      set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "-mavx2;-mfma")
    elseif(source MATCHES "_avx512\\.cpp$")
      set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "-mavx512f;-mavx512dq;-mavx512vl;-mfma;-mprefer-vector-width=512")
    endif()
  endforeach()
endfunction()

function(rhexis_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Werror)
endfunction()
