# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
# The documented programs as a stranger compiles them: strict, and without exceptions and RTTI as engines are.
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/examples)
foreach(name levels first_bytes by_hand stream view)
  add_executable(${name} ${EXAMPLES}/${name}.cpp)
endforeach()
# The C interface, from C.
foreach(name stream_file view_file)
  add_executable(${name} ${EXAMPLES}/${name}.c)
  target_link_libraries(${name} PRIVATE vsplit::vsplit)
  set_target_properties(${name} PROPERTIES C_STANDARD 99 C_EXTENSIONS OFF)
  target_compile_options(${name} PRIVATE $<$<COMPILE_LANGUAGE:C>:-Wall -Wextra -Wpedantic -Werror>)
endforeach()
add_executable(refusing ${CMAKE_CURRENT_LIST_DIR}/refusing.cpp)
foreach(name levels first_bytes by_hand stream view refusing)
  target_link_libraries(${name} PRIVATE vsplit::vsplit)
  target_compile_options(${name} PRIVATE -Wall -Wextra -Wpedantic -Werror -fno-exceptions -fno-rtti)
endforeach()
