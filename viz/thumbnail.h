#pragma once

#include <string>

#include "base/files.h"

namespace pendular::viz {

/// A PNG picture as the bytes of a JPEG, at most `width` pixels wide, by the mean of the pixels that fall
/// into one. BadInput where the file is no PNG of 8 bits per channel.
std::string thumbnail(const fs::path& picture, int width);

}  // namespace pendular::viz
