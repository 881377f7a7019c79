# Writes OUT, the source that holds FILES, and the gzipped PAGE, as embedded_files.h says.
function(add_entry list file text)
  get_filename_component(name "${file}" NAME)
  set(${list} "${${list}}    {\"${name}\", ${text}},\n" PARENT_SCOPE)
endfunction()

set(texts "")
foreach(file IN LISTS FILES)
  file(READ "${file}" text)
  add_entry(texts "${file}" "R\"file(${text})file\"")
endforeach()

# Bytes by the one: compilers need not take strings as long as these.
set(page "")
set(bytes "")
set(number 0)
foreach(file IN LISTS PAGE)
  file(READ "${file}" hex HEX)
  string(REGEX REPLACE "(................................)" "\\1\n    " hex "${hex}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," hex "${hex}")
  string(APPEND bytes "constexpr char kBytes${number}[] = {\n    ${hex}};\n")
  add_entry(page "${file}" "std::string_view(kBytes${number}, sizeof kBytes${number})")
  math(EXPR number "${number} + 1")
endforeach()

file(WRITE "${OUT}" "// Made by embed_files.cmake.
#include \"server/embedded_files.h\"

#include <iterator>
#include <stdexcept>
#include <string>

namespace dynslam {
namespace {

constexpr EmbeddedFile kTexts[] = {
${texts}};
${bytes}// With one more at the end, as there may be none.
constexpr EmbeddedFile kPage[] = {
${page}    {}};

}  // namespace

std::string_view embedded_file(std::string_view name) {
  for (const EmbeddedFile& file : kTexts)
    if (file.name == name) return file.bytes;
  throw std::logic_error(std::string(\"there is no such file in the program: \").append(name));
}

std::span<const EmbeddedFile> embedded_page() { return {kPage, std::size(kPage) - 1}; }

}  // namespace dynslam
")
