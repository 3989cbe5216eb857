# The typed configuration, and the schemas of etc/ as C++.
foreach(schema DEVICE RMACD MODBUS-SPINDLE MODBUS-IO TOOLS MEASURING-PLAN)
  string(TOLOWER ${schema} name)
  set(file ${PROJECT_SOURCE_DIR}/etc/${name}.schema.json)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  file(READ ${file} RMAC_${schema}_SCHEMA)
endforeach()
configure_file(${CMAKE_CURRENT_LIST_DIR}/schemas.cpp.in ${CMAKE_CURRENT_BINARY_DIR}/schemas.cpp @ONLY)
target_sources(rmac_gateway PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/schemas.cpp)
# Relative, so that an installation may be moved; see default_folders().
file(RELATIVE_PATH RMAC_DRIVERS_FROM_SBIN /${CMAKE_INSTALL_SBINDIR} /${RMAC_DRIVERS_INSTALL})
file(RELATIVE_PATH RMAC_HELPERS_FROM_SBIN /${CMAKE_INSTALL_SBINDIR} /${RMAC_HELPERS_INSTALL})
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/default_folders.cpp PROPERTIES COMPILE_DEFINITIONS
  "RMAC_HELPERS_FROM_SBIN=\"${RMAC_HELPERS_FROM_SBIN}\";RMAC_DRIVERS_FROM_SBIN=\"${RMAC_DRIVERS_FROM_SBIN}\";RMAC_STATE_FOLDER=\"${CMAKE_INSTALL_FULL_LOCALSTATEDIR}/lib/rmac\"")
# g++ 12 at -O3 sees an overlapping copy in std::string::replace as valijson calls it; there is none.
set_source_files_properties(${CMAKE_CURRENT_LIST_DIR}/json_schema.cpp PROPERTIES COMPILE_OPTIONS -Wno-restrict)
