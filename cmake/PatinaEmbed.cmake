# patina_embed(<target> <function> <files...>)
#
# Compiles text files into <target> as std::vector<EmbeddedFile> patina::<function>(), declared in the generated header
# "<function>.h"; a name is the file's name without its folder. Changed files are embedded again.
function(patina_embed target function)
  set(entries "")
  foreach(file IN LISTS ARGN)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    get_filename_component(name ${file} NAME)
    file(READ ${file} text)
    string(APPEND entries "        {\"${name}\", R\"embedded(${text})embedded\"},\n")
  endforeach()
  set(folder ${CMAKE_BINARY_DIR}/generated)
  file(CONFIGURE OUTPUT ${folder}/${function}.h @ONLY CONTENT
"#pragma once
#include <string_view>
#include <vector>

namespace patina {

struct EmbeddedFile {
    std::string_view name, text;
};

std::vector<EmbeddedFile> @function@();

}  // namespace patina
")
  file(CONFIGURE OUTPUT ${folder}/${function}.cpp @ONLY CONTENT
"#include \"@function@.h\"

namespace patina {

std::vector<EmbeddedFile> @function@() {
    return {
@entries@    };
}

}  // namespace patina
")
  target_sources(${target} PRIVATE ${folder}/${function}.cpp)
endfunction()
