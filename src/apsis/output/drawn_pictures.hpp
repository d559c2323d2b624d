#pragma once

#include <filesystem>

namespace apsis {

/// Numbers of files in the folder of pictures of a result.
struct picture_counts {
  int removed = 0,  ///< pictures that the program had drawn
      left = 0;     ///< other files, and pictures that were changed
};

/// Removes the pictures that `apsis plot` and `apsis report` drew of the results in a folder. The file
/// `.written` of the folder `pictures` lists them. A picture is removed if its size and its checksum are
/// those of the list, and the folder `pictures` if it is empty then. Links and other files stay. Does nothing
/// without a folder `pictures`, or if it is a link.
picture_counts remove_drawn_pictures(const std::filesystem::path& results);

}  // namespace apsis
