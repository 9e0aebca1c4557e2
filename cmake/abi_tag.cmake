# Writes OUTPUT (abi_tag.h) if its content changes. See framework/CMakeLists.txt.
execute_process(COMMAND ${COMPILER} -std=c++20 -E -P -DGNOMON_ABI_PROBE -I${INCLUDE} -x c++ ${INCLUDE}/gnomon/plugin.h
                OUTPUT_VARIABLE text RESULT_VARIABLE failed ERROR_VARIABLE message)
if(failed)
  message(FATAL_ERROR "the public headers do not preprocess: ${message}")
endif()
string(SHA256 hash "${text}")
string(SUBSTRING ${hash} 0 16 hash)
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT [[
// Generated: what a plugin and this framework must have in common. The headers are those that the framework was built with;
// the rest is asked of whoever compiles this.
#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define GNOMON_ABI_SANITIZE "address"
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define GNOMON_ABI_SANITIZE "address"
#elif !defined(GNOMON_ABI_SANITIZE)
#define GNOMON_ABI_SANITIZE "off"
#endif

#ifdef _GLIBCXX_DEBUG
#define GNOMON_ABI_DEBUG "on"
#else
#define GNOMON_ABI_DEBUG "off"
#endif

#define GNOMON_ABI_TAG \
  "gnomon-@VERSION@ compiler=" __VERSION__ " sanitize=" GNOMON_ABI_SANITIZE " debug=" GNOMON_ABI_DEBUG " headers=@hash@"
]] @ONLY)
