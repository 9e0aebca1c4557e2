# Writes OUTPUT (abi_tag.h) if its content changes. See framework/CMakeLists.txt.
execute_process(COMMAND ${COMPILER} -std=c++20 -E -P -DGNOMON_ABI_PROBE -I${INCLUDE} -x c++ ${INCLUDE}/gnomon/plugin.h
                OUTPUT_VARIABLE text RESULT_VARIABLE failed ERROR_VARIABLE message)
if(failed)
  message(FATAL_ERROR "the public headers do not preprocess: ${message}")
endif()
string(SHA256 hash "${text}")
string(SUBSTRING ${hash} 0 16 hash)
set(tag "gnomon-${VERSION} ${COMPILER_ID} ${BUILD} sanitize=${SANITIZE} headers=${hash}")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "// Generated: what a plugin and this framework must have in common.\n#pragma once\n#define GNOMON_ABI_TAG \"${tag}\"\n")
