# One static library per folder. A target finds the headers of a folder only through that folder's
# own include directory (a link of the same name), so including a folder without linking it fails to compile.
#
#   pendular_folder_library(packing SOURCES a.cpp b.cpp PUBLIC base PRIVATE VTK::IOXML APART b.cpp)
#
# Where CMAKE_UNITY_BUILD is on (presets), eight sources are compiled as one: most of the time to compile goes into headers and
# templates that they share. APART: sources whose local names are those of others, like kinds of observation; by themselves.
function(pendular_folder_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;PUBLIC;PRIVATE;APART" ${ARGN})
  set(root ${PROJECT_BINARY_DIR}/include/${name})
  file(MAKE_DIRECTORY ${root})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${root}/${name} SYMBOLIC)
  add_library(${name} STATIC ${arg_SOURCES})
  set_source_files_properties(${arg_APART} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_include_directories(${name} PUBLIC ${root})
  # Position-independent: shared objects (VTK's writer, the Python module) hold copies.
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_precompile_headers(${name} REUSE_FROM pendular_precompiled)
  target_link_libraries(${name} PUBLIC ${arg_PUBLIC} PRIVATE pendular_flags ${arg_PRIVATE})
endfunction()

# A shared object that a folder loads where it needs it (base/module.h): what takes long to load. The folder gets the
# file's name as a macro: pendular-dicom as PENDULAR_DICOM. The run path of the programs finds it (cmake/options.cmake).
#
#   pendular_module(pendular-dicom FOR volume SOURCES dicom_library.cpp LINKS ITKIOGDCM)
function(pendular_module name)
  cmake_parse_arguments(arg "" "FOR" "SOURCES;LINKS" ${ARGN})
  string(TOUPPER ${name} macro)
  string(REPLACE - _ macro ${macro})
  add_library(${name} MODULE ${arg_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_BINARY_DIR}/include/${arg_FOR})
  target_link_libraries(${name} PRIVATE pendular_flags ${arg_LINKS})
  set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${PENDULAR_MODULES})
  target_compile_definitions(${arg_FOR} PRIVATE ${macro}="$<TARGET_FILE_NAME:${name}>")
  add_dependencies(${arg_FOR} ${name})
  install(TARGETS ${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/pendular COMPONENT program)
endfunction()
