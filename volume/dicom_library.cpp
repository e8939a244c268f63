#include "volume/dicom_library.h"

#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>

namespace pendular {
namespace {

itk::ImageIOBase::Pointer new_reader() {
  return itk::GDCMImageIO::New().GetPointer();
}

DicomSeries series_in(const std::string& folder) {
  const auto names = itk::GDCMSeriesFileNames::New();
  names->SetUseSeriesDetails(true);
  names->SetDirectory(folder);
  const auto& series = names->GetSeriesUIDs();
  DicomSeries found{.count = series.size(), .files = {}};
  if (found.count == 1) found.files = names->GetFileNames(series.front());
  return found;
}

}  // namespace
}  // namespace pendular

extern "C" const pendular::DicomLibrary pendular_dicom = {pendular::new_reader, pendular::series_in};
