# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
# vsplit_embed_viewer(TARGET FOLDER): the files of FOLDER become viewer_assets() of TARGET; none if there is no such folder.
# They are taken in by the assembler (.incbin), which costs nothing to compile however large they are.
function(vsplit_embed_viewer target folder)
  file(GLOB_RECURSE files RELATIVE ${folder} CONFIGURE_DEPENDS ${folder}/*)
  list(SORT files)
  set(symbols "")
  set(table "")
  set(paths "")
  set(number 0)
  foreach(file IN LISTS files)
    list(APPEND paths ${folder}/${file})
    string(APPEND symbols "extern const char vsplit_asset_${number}[], vsplit_asset_${number}_end[];\n"
      "__asm__(\".pushsection .rodata\\n.global vsplit_asset_${number}\\nvsplit_asset_${number}:\\n.incbin \\\"${folder}/${file}\\\"\\n\"\n"
      "        \".global vsplit_asset_${number}_end\\nvsplit_asset_${number}_end:\\n.byte 0\\n.popsection\\n\");\n")
    string(APPEND table "    {\"${file}\", {vsplit_asset_${number}, std::size_t(vsplit_asset_${number}_end - vsplit_asset_${number})}},\n")
    math(EXPR number "${number} + 1")
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/viewer_assets.cpp)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT "// Made by assets.cmake.
#include <array>
#include \"serve/assets.hpp\"
extern \"C\" {
${symbols}}
namespace vsplit::app {
static const std::array<Asset, ${number}> kAssets{{
${table}}};
std::span<const Asset> viewer_assets() { return kAssets; }
}  // namespace vsplit::app
")
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS "${paths}")
  target_sources(${target} PRIVATE ${source})
  if(number EQUAL 0)
    message(STATUS "vsplit serve: without the web viewer (./run web builds it)")
  endif()
endfunction()
