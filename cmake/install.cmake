# What `cmake --install` puts where, in components: program (the programs, their manual pages, completions, samples and
# pages), python (the module and the library it rests on), development (headers and targets for C++). Nothing of it names
# the prefix, so that the whole can be moved.
set(manual ${PROJECT_BINARY_DIR}/manual)
add_custom_command(OUTPUT ${manual}/_pendular COMMAND pendular-pictures manual ${manual} DEPENDS pendular-pictures
  COMMENT "Manual pages and completions" VERBATIM)
add_custom_target(manual ALL DEPENDS ${manual}/_pendular)
install(DIRECTORY ${manual}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT program)
install(FILES ${manual}/pendular.bash RENAME pendular
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(FILES ${manual}/_pendular DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)

install(DIRECTORY samples DESTINATION ${CMAKE_INSTALL_DATADIR}/pendular COMPONENT program)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

if(PENDULAR_PYTHON)
  set(module ${PENDULAR_PYTHON_DIR}/pendular)
  install(DIRECTORY python/pendular/ DESTINATION ${module} COMPONENT python
    FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
  install(DIRECTORY python/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-pendular COMPONENT python)
  install(FILES LICENSE RENAME copyright DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-pendular COMPONENT python)

  # find_package(pendular) gives pendular::library.
  include(CMakePackageConfigHelpers)
  set(config ${CMAKE_INSTALL_LIBDIR}/cmake/pendular)
  install(TARGETS pendular-library EXPORT pendular LIBRARY COMPONENT python NAMELINK_COMPONENT development)
  foreach(folder ${PENDULAR_LIBRARY_FOLDERS})
    install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pendular COMPONENT development
      FILES_MATCHING PATTERN "*.h" PATTERN "*-inl.h" EXCLUDE PATTERN "pipette" EXCLUDE)
  endforeach()
  install(EXPORT pendular NAMESPACE pendular:: FILE pendularTargets.cmake DESTINATION ${config} COMPONENT development)
  configure_package_config_file(cmake/pendularConfig.cmake.in ${PROJECT_BINARY_DIR}/pendularConfig.cmake
    INSTALL_DESTINATION ${config} PATH_VARS CMAKE_INSTALL_DATADIR)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/pendularConfigVersion.cmake COMPATIBILITY ExactVersion)
  install(FILES ${PROJECT_BINARY_DIR}/pendularConfig.cmake ${PROJECT_BINARY_DIR}/pendularConfigVersion.cmake
    DESTINATION ${config} COMPONENT development)
endif()
