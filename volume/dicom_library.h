#pragma once

#include <string>
#include <vector>

#include "volume/itk_images.h"

// DICOM files by GDCM, through ITK. Internal to volume.

namespace pendular {

/// The series of a folder.
struct DicomSeries {
  std::size_t count = 0;
  std::vector<std::string> files;  ///< of the only one, by position; empty where there are several
};

/// GDCM fills its dictionaries when it is loaded, a fifth of the start of a program that links it, so that it
/// is in a shared object of its own, loaded with the first DICOM file. What these throw are ITK's exceptions.
struct DicomLibrary {
  itk::ImageIOBase::Pointer (*reader)();
  DicomSeries (*series)(const std::string& folder);
};

const DicomLibrary& dicom_library();

}  // namespace pendular

extern "C" const pendular::DicomLibrary pendular_dicom;
