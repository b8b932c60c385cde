# Writes generated/bench/git_hash.h when the commit has changed since it was last written, so that only version.cpp
# recompiles. Run by every build: cmake -DSOURCE_DIR=... -DHEADER=... -P git_hash.cmake
execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --abbrev=12 --dirty=+ --exclude=*
  OUTPUT_VARIABLE hash ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
if(NOT hash)
  set(hash unknown)
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#pragma once\n#define PROBEBENCH_GIT_HASH \"${hash}\"\n" @ONLY)
