#include "volume/volume.h"

#include "base/path_kind.h"
#include "volume/image_io.h"

#include <itkMetaImageIO.h>
#include <itkTIFFImageIO.h>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "volume/format.h"

namespace pendular {
namespace {

itk::IOComponentEnum component(const Volume& volume) {
  constexpr itk::IOComponentEnum components[] = {itk::IOComponentEnum::UCHAR, itk::IOComponentEnum::USHORT,
                                                 itk::IOComponentEnum::FLOAT, itk::IOComponentEnum::UINT};
  return components[volume.pixels.index()];
}

itk::ImageIOBase::Pointer writer_of(const fs::path& path, const Volume& volume) {
  const std::string extension = lower_extension(path);
  if (extension == ".mha") return itk::MetaImageIO::New().GetPointer();
  if (extension != ".tif" && extension != ".tiff")
    throw BadUsage(fmt::format("{}: found extension '{}', expected .mha or .tif", path.string(), extension));
  if (std::holds_alternative<std::vector<std::uint32_t>>(volume.pixels))
    throw BadUsage(fmt::format("{}: found voxels of 32 bit, expected .mha for them", path.string()));
  auto tiff = itk::TIFFImageIO::New();
  tiff->UseCompressionOff();
  return tiff.GetPointer();
}

}  // namespace

std::string pixel_type(const Volume& volume) {
  constexpr const char* names[] = {"uint8", "uint16", "float", "uint32"};
  return names[volume.pixels.index()];
}

void release(const Volume& volume) {
  if (volume.file) volume.file->release();
}

void write_volume(const fs::path& path, const Volume& volume, const Provenance& provenance) {
  const auto io = writer_of(path, volume);
  write_atomically(path, [&](const fs::path& temporary) {
    itk::ImageIORegion region(3);
    io->SetNumberOfDimensions(3);
    for (unsigned axis = 0; axis < 3; ++axis) {
      io->SetDimensions(axis, volume.size[axis]);
      io->SetSpacing(axis, volume.spacing * 1e6);
      io->SetOrigin(axis, volume.origin[axis] * 1e6);
      region.SetIndex(axis, 0);
      region.SetSize(axis, volume.size[axis]);
    }
    io->SetIORegion(region);
    io->SetNumberOfComponents(1);
    io->SetPixelType(itk::IOPixelEnum::SCALAR);
    io->SetComponentType(component(volume));
    itk::EncapsulateMetaData<std::string>(io->GetMetaDataDictionary(), "LengthUnit", "um");
    if (!provenance.version.empty())
      itk::EncapsulateMetaData<std::string>(io->GetMetaDataDictionary(), "Provenance",
                                            to_json(provenance).dump());
    io->SetFileName(temporary.string());
    try {
      const SilentStandardError silent;
      with_pixels(volume, [&](auto pixels) { io->Write(pixels.data()); });
    } catch (const itk::ExceptionObject& error) {
      throw ComputationFailed(
          fmt::format("{}: cannot be written: {}", path.string(), first_line(error.GetDescription())));
    }
    // The library does not always say that the disc is full.
    const auto bytes = with_pixels(volume, [](auto pixels) { return pixels.size_bytes(); });
    if (!is_there(temporary) || fs::file_size(temporary) < bytes)
      throw ComputationFailed(
          fmt::format("{}: cannot be written: no space for {} bytes", path.string(), bytes));
  });
}

}  // namespace pendular
