# Found instead of CMake's own, which asks the interpreter anew for each generator.
if(TARGET Python3::Interpreter AND "${Python3_FIND_COMPONENTS}" STREQUAL "Interpreter")
  set(Python3_FOUND TRUE)
  set(Python3_Interpreter_FOUND TRUE)
else()
  include(${CMAKE_ROOT}/Modules/FindPython3.cmake)
endif()
