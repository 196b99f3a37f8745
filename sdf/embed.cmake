# farfield_embed(TARGET FUNCTION FILE...)
# Adds to TARGET a function `std::string_view farfield::FUNCTION(std::string_view name)` that returns the text of
# the named file (its name without folder), or an empty view. The texts are compiled in, so the program needs no files.
# Run as a script (cmake -D OUT=... -D FUNCTION=... -D FILES=... -P embed.cmake) it writes that source file.
if(CMAKE_SCRIPT_MODE_FILE)
  set(text "#include <string_view>\n#include <utility>\n\nnamespace farfield {\n\nstd::string_view ${FUNCTION}(std::string_view name);\n\nstd::string_view ${FUNCTION}(std::string_view name) {\n    using namespace std::string_view_literals;\n    static constexpr std::pair<std::string_view, std::string_view> files[] = {\n")
  string(REPLACE "|" ";" FILES "${FILES}")
  foreach(file IN LISTS FILES)
    get_filename_component(name "${file}" NAME)
    file(READ "${file}" content)
    string(APPEND text "        {\"${name}\"sv, R\"embedded(${content})embedded\"sv},\n")
  endforeach()
  string(APPEND text "    };\n    for (const auto& [key, content] : files)\n        if (key == name) return content;\n    return {};\n}\n\n}  // namespace farfield\n")
  file(WRITE "${OUT}" "${text}")
  return()
endif()

set(farfield_embed_script "${CMAKE_CURRENT_LIST_FILE}")
function(farfield_embed target function)
  set(out "${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp")
  list(TRANSFORM ARGN PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/" OUTPUT_VARIABLE files)
  string(REPLACE ";" "|" joined "${files}")
  add_custom_command(OUTPUT "${out}" DEPENDS ${files} "${farfield_embed_script}" VERBATIM
    COMMAND ${CMAKE_COMMAND} -D "OUT=${out}" -D "FUNCTION=${function}" -D "FILES=${joined}" -P "${farfield_embed_script}")
  target_sources(${target} PRIVATE "${out}")
endfunction()
