# Turns the shader files into one C++ file:  cmake -DOUTPUT=… -DFOLDER=… -DSHADERS=a;b -P embed.cmake
set(text "// Made from shaders/ by the build.\n#include \"gpu/shaders.h\"\n\n#include <utility>\n\nnamespace limn {\nnamespace {\n\nconstexpr std::pair<std::string_view, std::string_view> kShaders[] = {\n")
foreach(shader IN LISTS SHADERS)
  file(READ ${FOLDER}/${shader} source)
  string(APPEND text "{\"${shader}\", R\"glsl(${source})glsl\"},\n")
endforeach()
string(APPEND text "};\n\n}  // namespace\n\nstd::string_view embeddedShader(std::string_view path) {\n    for (const auto& [name, source] : kShaders)\n        if (name == path) return source;\n    return {};\n}\n\n}  // namespace limn\n")
file(WRITE ${OUTPUT} "${text}")
