# rmac_module(NAME SOURCES... [FOLDER sub/folder]): a shared object that the configuration system loads by name.
# Built with -fno-gnu-unique and hidden visibility, so that dlclose unmaps it and a rebuilt one really replaces it.
set(RMAC_DRIVERS_OUTPUT ${CMAKE_BINARY_DIR}/drivers)
set(RMAC_DRIVERS_INSTALL ${CMAKE_INSTALL_LIBDIR}/rmac/drivers)
add_custom_target(rmac_modules COMMENT "All modules of the device tree")
function(rmac_module name)
  cmake_parse_arguments(MODULE "" "FOLDER" "SOURCES" ${ARGN})
  add_library(${name} MODULE ${MODULE_SOURCES})
  add_dependencies(rmac_modules ${name})
  target_link_libraries(${name} PRIVATE rmac_compiler rmac_sdk)
  target_compile_options(${name} PRIVATE -fno-gnu-unique)
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY ${RMAC_DRIVERS_OUTPUT}/${MODULE_FOLDER})
  install(TARGETS ${name} LIBRARY DESTINATION ${RMAC_DRIVERS_INSTALL}/${MODULE_FOLDER})
endfunction()

# rmac_mechanism(FOLDER): puts a mechanism's device.json beside its modules, in the build tree and in the installed one.
function(rmac_mechanism folder)
  configure_file(${CMAKE_CURRENT_SOURCE_DIR}/device.json ${RMAC_DRIVERS_OUTPUT}/${folder}/device.json COPYONLY)
  install(FILES device.json DESTINATION ${RMAC_DRIVERS_INSTALL}/${folder})
endfunction()
