# Where an installation keeps its configuration, from the prefix that it is installed with, which may be another than the
# build's. Included by install scripts, with `sysconfdir` as the build has it; sets `etc`.
if(IS_ABSOLUTE "${sysconfdir}")
  set(etc "${sysconfdir}/rmac")
elseif(CMAKE_INSTALL_PREFIX MATCHES "^/(usr)?$")
  set(etc "/${sysconfdir}/rmac")  # as Debian has it
else()
  set(etc "${CMAKE_INSTALL_PREFIX}/${sysconfdir}/rmac")
endif()
