# rmac_room(NAME [USES targets…] [PRIVATE targets…]): the static library rmac_NAME of the .cpp files of this folder, or, where
# there are headers alone, an interface. USES names the rooms and libraries whose headers its files include; tests/layout
# checks that no file includes what its room does not name.
function(rmac_room name)
  cmake_parse_arguments(ROOM "" "" "USES;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  if(sources)
    add_library(rmac_${name} STATIC ${sources})
    target_include_directories(rmac_${name} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(rmac_${name} PUBLIC ${ROOM_USES} PRIVATE ${ROOM_PRIVATE} rmac_compiler)
    rmac_is_fuzzed(rmac_${name})
  else()
    add_library(rmac_${name} INTERFACE)
    target_include_directories(rmac_${name} INTERFACE ${PROJECT_SOURCE_DIR})
    target_link_libraries(rmac_${name} INTERFACE ${ROOM_USES})
  endif()
endfunction()
