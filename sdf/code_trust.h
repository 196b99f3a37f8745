// Custom code comes with scene files, and scene files come from elsewhere. What a file says is checked (see
// custom_code.h), but a graphics driver's compiler is no place for texts of strangers. So code is given to it only when
// the user wrote it here or accepted it, or when it comes with Farfield. Remembered are hashes of texts, in a file of
// the user's.
#pragma once

#include "sdf/custom_code.h"
#include "sdf/scene.h"

#include <filesystem>
#include <string>
#include <unordered_set>
#include <vector>

namespace farfield {

class CodeTrust {
public:
    /// Remembers in `file`; nowhere where that is empty. A file that cannot be read or written is no error: then what
    /// is accepted counts for the life of this object.
    explicit CodeTrust(std::filesystem::path file = {});
    /// farfield/trusted in the user's folder of settings; empty where there is none.
    static std::filesystem::path user_file();

    bool knows(const CustomCode& code) const;
    void accept(const CustomCode& code);
    /// Changes with everything that is accepted.
    std::size_t revision() const { return accepted_.size(); }

private:
    void read();
    void write() const;

    std::filesystem::path file_;
    std::vector<std::string> order_;  ///< hashes, the newest at the end
    std::unordered_set<std::string> accepted_;
};

/// Where code stands in a scene that may not run yet.
struct UnknownCode {
    std::string path;  ///< as root/children[2] "ring"
    const Node* node;
};
std::vector<UnknownCode> unknown_code(const Scene& scene, const CodeTrust& trust);

/// The scene with nothing where unknown code would be: what may be given to the driver.
Scene without_unknown_code(const Scene& scene, const CodeTrust& trust);

}  // namespace farfield
