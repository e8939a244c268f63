# cmake -DSOURCE=… -DFALLBACK=0.1.0 -DOUT=… -P describe_version.cmake
# Writes a header with the version that provenance states: `git describe` of the sources, FALLBACK where they are
# no repository (a tarball). Without a tag the version precedes the commit: 0.1.0+98470bd. Left alone if unchanged.
cmake_minimum_required(VERSION 3.25)
set(version ${FALLBACK})
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE}/.git)
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --tags --match "v*" --dirty
    OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(failed)
    execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --exclude "*" --dirty
      OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
    set(described "${FALLBACK}+${described}")
  endif()
  if(NOT failed)
    string(REGEX REPLACE "^v" "" version "${described}")
  endif()
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#define PENDULAR_VERSION \"${version}\"\n" @ONLY)
