# Found instead of the real one: leaves out the C++ side, which Python never loads. The C introspection
# type support stays, since rmw_fastrtps refuses a type without it.
find_package(ament_cmake_core REQUIRED)
find_package(rosidl_core_generators REQUIRED)
list(FILTER AMENT_EXTENSIONS_rosidl_generate_idl_interfaces EXCLUDE REGEX "_cpp:")
