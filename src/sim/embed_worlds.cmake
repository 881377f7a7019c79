# Writes OUT, the source that holds the WORLDS (a list of .toml files, the default first) as builtin_worlds.h says.
set(entries "")
list(LENGTH WORLDS count)
foreach(file IN LISTS WORLDS)
  get_filename_component(name "${file}" NAME_WE)
  file(READ "${file}" text)
  string(APPEND entries "    {\"${name}\", R\"world(${text})world\"},\n")
endforeach()
file(WRITE "${OUT}" "// Made by embed_worlds.cmake.
#include \"sim/builtin_worlds.h\"

namespace dynslam {

std::span<const BuiltinWorld> builtin_worlds() {
  static constexpr BuiltinWorld kWorlds[] = {
${entries}  };
  return kWorlds;
}

}  // namespace dynslam
")
