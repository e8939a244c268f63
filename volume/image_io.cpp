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

namespace {

/// All of a file, as ITK has them in memory.
void read_numbers(itk::ImageIOBase& io, const fs::path& path, char* target) {
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned axis = 0; axis < io.GetNumberOfDimensions(); ++axis) {
    region.SetIndex(axis, 0);
    region.SetSize(axis, io.GetDimensions(axis));
  }
  io.SetIORegion(region);
  guarded(path, [&] { io.Read(target); });
}

}  // namespace

void write_png(const fs::path& path, std::size_t width, std::size_t height,
               std::span<const std::uint8_t> pixels) {
  const auto io = itk::PNGImageIO::New();
  io->SetNumberOfDimensions(2);
  itk::ImageIORegion region(2);
  for (unsigned axis = 0; axis < 2; ++axis) {
    io->SetDimensions(axis, axis == 0 ? width : height);
    region.SetSize(axis, axis == 0 ? width : height);
  }
  io->SetIORegion(region);
  io->SetPixelType(itk::IOPixelEnum::RGB);
  io->SetNumberOfComponents(3);
  io->SetComponentType(itk::IOComponentEnum::UCHAR);
  write_atomically(path, [&](const fs::path& temporary) {
    io->SetFileName(temporary.string());
    try {
      const SilentStandardError silent;
      io->Write(pixels.data());
    } catch (const itk::ExceptionObject& error) {
      throw ComputationFailed(
          fmt::format("{}: cannot be written: {}", path.string(), first_line(error.GetDescription())));
    }
  });
}

Stored stored_type(const itk::ImageIOBase& io, const fs::path& path) {
  switch (io.GetComponentType()) {
    case itk::IOComponentEnum::UCHAR:
      return Stored::uint8;
    case itk::IOComponentEnum::USHORT:
      return Stored::uint16;
    case itk::IOComponentEnum::UINT:
      return Stored::uint32;
    case itk::IOComponentEnum::FLOAT:
      return Stored::float32;
    case itk::IOComponentEnum::CHAR:
      return Stored::int8;
    case itk::IOComponentEnum::SHORT:
      return Stored::int16;
    case itk::IOComponentEnum::INT:
      return Stored::int32;
    case itk::IOComponentEnum::DOUBLE:
      return Stored::float64;
    default:
      bad_input("{}: found pixel type {}, expected {}", path.string(),
                itk::ImageIOBase::GetComponentTypeAsString(io.GetComponentType()), kStoredTypes);
  }
}

Stored picture_type(const itk::ImageIOBase& io, const fs::path& path) {
  const Stored type = stored_type(io, path);
  if (type == Stored::uint32 || type == Stored::int32)
    bad_input("{}: found whole numbers of 32 bit, expected of 8 or 16 bit, or float", path.string());
  return type;
}

void read_pixels(itk::ImageIOBase& io, const fs::path& path, Volume& volume, std::size_t first) {
  const Stored type = stored_type(io, path);
  if (is_kept(type)) return read_numbers(io, path, bytes(volume) + first * width_of(type));
  std::vector<std::byte> numbers(static_cast<std::size_t>(io.GetImageSizeInBytes()));
  read_numbers(io, path, reinterpret_cast<char*>(numbers.data()));
  convert(numbers, type, false, volume, first);
}

}  // namespace pendular
