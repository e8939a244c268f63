#pragma once

#include <functional>
#include <list>
#include <string>
#include <vector>

#include "volume/volume.h"

namespace pendular {

/// A way in which volumes are stored. Adding one: its file, its test, its line in formats.cpp.
struct VolumeFormat {
  std::string name;  ///< as help and messages call it, with its extensions
  /// Whether a path is one of its volumes, by its name, its first bytes or what is said of it.
  std::function<bool(const fs::path& path, const ReadOptions& options)> recognises;
  /// The files that a volume is read from, the named one first; null: that one alone.
  std::function<std::vector<fs::path>(const fs::path& path)> files = nullptr;
  /// Reads one that is recognised. BadInput, in one line, for whatever does not hold a grey volume.
  std::function<Volume(const fs::path& path, const ReadOptions& options)> read;
};

/// Every format, in the order in which they are asked: the library's, then those that were added.
const std::list<VolumeFormat>& volume_formats();

/// A format that is no part of the library, at the end of the list as long as this lives. Add it before
/// anything reads volumes and remove it after, on one thread.
class AddedFormat {
 public:
  /// BadInput where its name is empty or known already, or it does not read.
  explicit AddedFormat(VolumeFormat format);
  ~AddedFormat();
  AddedFormat(const AddedFormat&) = delete;
  AddedFormat& operator=(const AddedFormat&) = delete;

 private:
  std::list<VolumeFormat>::const_iterator place_;
};

/// The first one that recognises a path; nullptr where none does.
const VolumeFormat* format_of(const fs::path& path, const ReadOptions& options = {});

/// Their names: "A, B or C".
std::string format_names();

/// With its dot, in small letters.
std::string lower_extension(const fs::path& path);

namespace formats {
VolumeFormat dicom();
VolumeFormat hdf5();
VolumeFormat zarr();
VolumeFormat slices();
VolumeFormat headerless();
VolumeFormat phoenix();
VolumeFormat meta_image();
VolumeFormat nrrd();
VolumeFormat tiff();
}  // namespace formats

}  // namespace pendular
