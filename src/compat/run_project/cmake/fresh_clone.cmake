# Included after project() in every package of a copied project: restores what a fresh clone lacks.

# git does not store empty folders.
file(MAKE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}/include")

# Messages of the project's other packages, declared or not: with earlier build results a missing dependency has no
# effect.
include_directories(AFTER "${CATKIN_DEVEL_PREFIX}/include")

# Message targets of packages that are not installed, on which others depend.
foreach(_target IN LISTS ABSENT_TARGETS)
  if(NOT TARGET ${_target})
    add_custom_target(${_target})
  endif()
endforeach()

# A missing dependency has no effect where another package has found it before.
file(READ "${CMAKE_CURRENT_SOURCE_DIR}/CMakeLists.txt" _text)
string(REGEX REPLACE "#[^\n]*" "" _text "${_text}")
if(_text MATCHES "generate_messages" AND NOT _text MATCHES "message_generation")
  find_package(message_generation QUIET)
endif()

# Boost's _1, _2 ... were global and included by ros.h.
file(GLOB_RECURSE _sources "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp" "${CMAKE_CURRENT_SOURCE_DIR}/*.h*")
set(_text "")
foreach(_source IN LISTS _sources)
  file(READ "${_source}" _source)
  string(APPEND _text "${_source}")
endforeach()
if(_text MATCHES "boost::bind *\\([^;]*[ ,]_[1-9]" AND NOT _text MATCHES "placeholders")
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-include boost/bind.hpp -DBOOST_BIND_GLOBAL_PLACEHOLDERS>")
endif()

# Packages that are not installed, such as costmap_2d, passed on where Eigen's headers are.
if(_text MATCHES "# *include *[<\"](unsupported/)?Eigen/" AND EXISTS /usr/include/eigen3)
  include_directories(AFTER SYSTEM /usr/include/eigen3)
endif()

# Accepted by the compilers of that time.
add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:-Wno-narrowing -fpermissive>")

# Tests are not built, but roslaunch_add_file_check defines one.
if(NOT CATKIN_ENABLE_TESTING AND NOT COMMAND catkin_run_tests_target)
  function(catkin_run_tests_target)
  endfunction()
endif()
