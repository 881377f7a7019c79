# Writes OUT, the source that holds FILES as embedded_files.h says.
set(entries "")
foreach(file IN LISTS FILES)
  get_filename_component(name "${file}" NAME)
  file(READ "${file}" text)
  string(APPEND entries "    {\"${name}\", R\"file(${text})file\"},\n")
endforeach()
file(WRITE "${OUT}" "// Made by embed_files.cmake.
#include \"server/embedded_files.h\"

#include <stdexcept>
#include <string>

namespace dynslam {

std::string_view embedded_file(std::string_view name) {
  struct File {
    std::string_view name, text;
  };
  static constexpr File kFiles[] = {
${entries}  };
  for (const File& file : kFiles)
    if (file.name == name) return file.text;
  throw std::logic_error(\"there is no file \" + std::string(name) + \" in the program\");
}

}  // namespace dynslam
")
