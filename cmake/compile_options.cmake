add_compile_options(-Wall -Wextra -Wpedantic)
# x86-64 has no fused multiply-add by default. Without it other processors give what the tests and claims were made with.
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  add_compile_options(-ffp-contract=off)
endif()
