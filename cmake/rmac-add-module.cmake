# What drivers are built with, inside this repository and outside of it (find_package(rmac) includes this file).
#
# rmac_add_module(NAME SOURCES … FOLDER type/configuration/Mechanism): a shared object that the configuration system loads by name.
# Built with -fno-gnu-unique and hidden visibility, so that dlclose unmaps it and a rebuilt one really replaces it (clang++ makes
# no such symbols).
#
# rmac_add_mechanism(FOLDER): puts the device.json of this source folder beside the mechanism's modules.
#
# Both land in <build>/drivers/FOLDER, and when installed in <prefix>/${rmac_DRIVERS_DIR}/FOLDER, where an appliance of that
# prefix looks for them.
function(rmac_add_module name)
  cmake_parse_arguments(MODULE "" "FOLDER" "SOURCES" ${ARGN})
  if(NOT MODULE_SOURCES OR NOT MODULE_FOLDER)
    message(FATAL_ERROR "rmac_add_module(${name}): SOURCES and FOLDER are needed")
  endif()
  add_library(${name} MODULE ${MODULE_SOURCES})
  target_link_libraries(${name} PRIVATE rmac::sdk)
  target_compile_features(${name} PRIVATE cxx_std_20)
  target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-gnu-unique>)
  set_target_properties(${name} PROPERTIES PREFIX "" CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/drivers/${MODULE_FOLDER})
  install(TARGETS ${name} LIBRARY DESTINATION ${rmac_DRIVERS_DIR}/${MODULE_FOLDER})
endfunction()

function(rmac_add_mechanism folder)
  configure_file(${CMAKE_CURRENT_SOURCE_DIR}/device.json ${CMAKE_BINARY_DIR}/drivers/${folder}/device.json COPYONLY)
  install(FILES device.json DESTINATION ${rmac_DRIVERS_DIR}/${folder})
endfunction()
