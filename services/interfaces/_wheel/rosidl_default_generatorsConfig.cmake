# Found instead of the real one: leaves out the C++ side, which Python never loads. The C introspection
# type support stays, since rmw_fastrtps refuses a type without it.
find_package(ament_cmake_core REQUIRED)
find_package(ament_cmake_python REQUIRED)
find_package(rosidl_core_generators REQUIRED)
list(FILTER AMENT_EXTENSIONS_rosidl_generate_idl_interfaces EXCLUDE REGEX "_cpp:")

# rclpy loads the extension of this type support only, which finds the others by itself.
function(rosidl_generator_py_get_typesupports found)
  set(${found} rosidl_typesupport_c PARENT_SCOPE)
endfunction()

# All packages are in one wheel: metadata and bytecode of each are not needed.
function(_ament_cmake_python_install_package name)
  cmake_parse_arguments(ARG "" "PACKAGE_DIR" "" ${ARGN})
  install(DIRECTORY "${ARG_PACKAGE_DIR}/" DESTINATION "${PYTHON_INSTALL_DIR}/${name}")
endfunction()
