// Views to come back to: the list below the camera's values, and what its entries come to.
#pragma once

#include "ui/ui.h"

namespace farfield {

/// Takes the camera to the bookmark, or the bookmark to the camera; empty where it is there already.
Edits go_to_bookmark(const Scene& scene, const Bookmark& bookmark);
Edits update_bookmark(const Scene& scene, const Bookmark& bookmark);

/// "Ctrl+1" for the first of nine that have keys; empty for others.
std::string bookmark_key(std::size_t index);

/// A click goes there, a drag changes the order, a menu has the rest.
void bookmark_list(Ui& ui, const Scene& scene, Edits& edits);

}  // namespace farfield
