// Any bytes as a scene file: an error that names a line of them, or a scene that is the same after saving.
#include "sdf/scene_file.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

void require(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "broken: %s\n", what);
    std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        const std::string saved = farfield::to_text(farfield::parse_scene(text, "a.json"));
        require(farfield::to_text(farfield::parse_scene(saved, "b.json")) == saved, "saved, the scene is another one");
    } catch (const farfield::SceneFileError& error) {
        require(error.file == "a.json", "what was saved cannot be read");
        require(error.line >= 1 && error.line <= 1 + std::count(text.begin(), text.end(), '\n'),
                "the line is in the file");
        require(!error.problem.empty(), "the error says what is wrong");
    }
    return 0;
}
