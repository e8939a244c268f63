#include "volume/image_io.h"

#include <itkPNGImageIO.h>
#include <itkTIFFImageIO.h>

#include <regex>

#include "volume/format.h"

namespace pendular {

std::string first_line(const char* text) {
  const std::string line(text);
  static const std::regex address(" ?\\(0x[0-9a-fA-F]+\\)");  // of the object that complains
  return std::regex_replace(line.substr(0, line.find_first_of("\r\n")), address, "");
}

itk::ImageIOBase::Pointer reader_of(const fs::path& path) {
  const std::string extension = lower_extension(path);
  itk::ImageIOBase::Pointer io;
  if (extension == ".tif" || extension == ".tiff") io = itk::TIFFImageIO::New();
  if (extension == ".png") io = itk::PNGImageIO::New();
  if (!io) bad_input("{}: found extension '{}', expected .tif, .tiff or .png", path.string(), extension);
  io->SetFileName(path.string());
  return io;
}

void read_header(itk::ImageIOBase& io, const fs::path& path) {
  guarded(path, [&] {
    if (!io.CanReadFile(path.c_str()))
      bad_input("{}: found no image of the kind its name says, expected one", path.string());
    io.ReadImageInformation();
  });
  if (io.GetNumberOfComponents() != 1 || io.GetPixelType() != itk::IOPixelEnum::SCALAR)
    bad_input("{}: found {} components per voxel, expected one (grey)", path.string(),
              io.GetNumberOfComponents());
}

void read_pixels(itk::ImageIOBase& io, const fs::path& path, char* target) {
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned axis = 0; axis < io.GetNumberOfDimensions(); ++axis) {
    region.SetIndex(axis, 0);
    region.SetSize(axis, io.GetDimensions(axis));
  }
  io.SetIORegion(region);
  guarded(path, [&] { io.Read(target); });
}

Volume::Pixels pixels_of(itk::IOComponentEnum type, const fs::path& path) {
  switch (type) {
    case itk::IOComponentEnum::UCHAR:
      return std::vector<std::uint8_t>();
    case itk::IOComponentEnum::USHORT:
      return std::vector<std::uint16_t>();
    case itk::IOComponentEnum::FLOAT:
      return std::vector<float>();
    case itk::IOComponentEnum::UINT:
      return std::vector<std::uint32_t>();
    default:
      bad_input("{}: found pixel type {}, expected unsigned 8 or 16 bit or float", path.string(),
                itk::ImageIOBase::GetComponentTypeAsString(type));
  }
}

}  // namespace pendular
