# Read after project() of every package of somebody else's project, in a copy of it: what clones lack.

# git keeps no empty folders.
file(MAKE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}/include")

# Messages of the project's other packages, declared or not: where they had been built before, a missing dependency
# went unnoticed.
include_directories(AFTER "${CATKIN_DEVEL_PREFIX}/include")

# Generated messages of packages that are not there, which others were to be built after.
foreach(_target IN LISTS ABSENT_TARGETS)
  if(NOT TARGET ${_target})
    add_custom_target(${_target})
  endif()
endforeach()

# Where every package of the author's machine had been found before, a missing dependency went unnoticed.
file(READ "${CMAKE_CURRENT_SOURCE_DIR}/CMakeLists.txt" _text)
string(REGEX REPLACE "#[^\n]*" "" _text "${_text}")
if(_text MATCHES "generate_messages" AND NOT _text MATCHES "message_generation")
  find_package(message_generation QUIET)
endif()

# boost's _1, _2 ... were global, and came with ros.h.
file(GLOB_RECURSE _sources "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp" "${CMAKE_CURRENT_SOURCE_DIR}/*.h*")
set(_text "")
foreach(_source IN LISTS _sources)
  file(READ "${_source}" _source)
  string(APPEND _text "${_source}")
endforeach()
if(_text MATCHES "boost::bind *\\([^;]*[ ,]_[1-9]" AND NOT _text MATCHES "placeholders")
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-include boost/bind.hpp -DBOOST_BIND_GLOBAL_PLACEHOLDERS>")
endif()

# What the compilers of that time let pass.
add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Wno-narrowing -fpermissive>")

# Tests are not built here; roslaunch_add_file_check asks for one all the same.
if(NOT CATKIN_ENABLE_TESTING AND NOT COMMAND catkin_run_tests_target)
  function(catkin_run_tests_target)
  endfunction()
endif()
