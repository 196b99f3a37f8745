// `farfield contact-sheet`: every kind of the table in one picture.
#pragma once

#include "renderer/context.h"

#include <glm/vec2.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace farfield {

struct ContactSheetOptions {
    std::filesystem::path output;
    glm::ivec2 tile{200, 200};  ///< pixels for each kind
    int columns = 8;
    std::vector<std::string> only;  ///< keys of kinds; empty: all
    int frames = 16;
    ContextKind context = ContextKind::automatic;
};

/// Returns the exit status as the commands of commands.h do; throws std::invalid_argument for an unknown kind.
int run_contact_sheet(const ContactSheetOptions& options);

}  // namespace farfield
