# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
# The library alone: headers, archive, CMake package. The command is installed when it was built.
include(CMakePackageConfigHelpers)
install(TARGETS vsplit EXPORT vsplit-targets)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/lib/include/vsplit DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT vsplit-targets NAMESPACE vsplit:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vsplit)
file(WRITE ${PROJECT_BINARY_DIR}/vsplit-config.cmake
"include(CMakeFindDependencyMacro)
find_dependency(zstd CONFIG)
find_dependency(draco CONFIG)
include(\${CMAKE_CURRENT_LIST_DIR}/vsplit-targets.cmake)
")
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vsplit-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vsplit-config.cmake ${PROJECT_BINARY_DIR}/vsplit-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vsplit)
if(TARGET vsplit_command)
  install(TARGETS vsplit_command)
endif()
