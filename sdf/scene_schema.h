// The scene format as a JSON Schema, for editors and validators that know nothing of Farfield.
#pragma once

#include <string>

namespace farfield {

/// JSON Schema, draft 07 (the newest that Visual Studio Code supports in full), made from the tables that the reader
/// uses; scenes/schema.json holds it. It refuses what the reader refuses, but for what a schema cannot say: names that
/// are taken, materials that do not exist, keys given twice, custom code and what it declares, nesting and size of the
/// file. It compares a number before, the reader after rounding to single precision.
std::string scene_schema();

}  // namespace farfield
