#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "volume/format.h"

namespace pendular {
namespace {

std::list<VolumeFormat>& all_formats() {
  static std::list<VolumeFormat> all = {formats::hdf5(),       formats::zarr(),       formats::dicom(),
                                        formats::slices(),     formats::headerless(), formats::phoenix(),
                                        formats::meta_image(), formats::nrrd(),       formats::tiff()};
  return all;
}

}  // namespace

const std::list<VolumeFormat>& volume_formats() {
  return all_formats();
}

AddedFormat::AddedFormat(VolumeFormat format) {
  if (format.name.empty() || !format.recognises || !format.read)
    bad_input("volume format \"{}\": expected a name, and that it recognises and reads", format.name);
  for (const auto& known : all_formats())
    if (known.name == format.name) bad_input("volume format \"{}\": there is one of that name", format.name);
  place_ = all_formats().insert(all_formats().end(), std::move(format));
}

AddedFormat::~AddedFormat() {
  all_formats().erase(place_);
}

const VolumeFormat* format_of(const fs::path& path, const ReadOptions& options) {
  for (const auto& format : all_formats())
    if (format.recognises(path, options)) return &format;
  return nullptr;
}

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

std::string format_names() {
  const auto& all = all_formats();
  std::string names;
  std::size_t left = all.size();
  for (const auto& format : all) {
    names += format.name;
    if (--left > 0) names += left == 1 ? " or " : ", ";
  }
  return names;
}

}  // namespace pendular
