# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
# find_package(draco) of the WebAssembly build: what CMakeLists.txt beside this one has built. VSPLIT_DRACO_BUILD and
# DRACO_SOURCE say where.
if(NOT TARGET draco::draco)
  add_library(draco::draco STATIC IMPORTED GLOBAL)
  set_target_properties(draco::draco PROPERTIES IMPORTED_LOCATION ${VSPLIT_DRACO_BUILD}/libdraco.a)
  target_include_directories(draco::draco INTERFACE ${DRACO_SOURCE}/src ${VSPLIT_DRACO_BUILD})
endif()
set(draco_FOUND TRUE)
