#include "packing/polydata.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "scratch.h"

namespace pendular {
namespace {

using test::ScratchFolder;

PolyTable table_of(std::size_t count) {
  PolyTable table;
  std::vector<double> size;
  std::vector<std::int64_t> id;
  std::vector<Vec3> displacement;
  for (std::size_t k = 0; k < count; ++k) {
    table.points.emplace_back(random_normal(1, 3 * k), random_normal(1, 3 * k + 1),
                              random_normal(1, 3 * k + 2));
    size.push_back(random_uniform(2, k));
    id.push_back(static_cast<std::int64_t>(random_bits(3, k) >> 1));
    displacement.push_back(1e-7 * table.points.back());
    if (k > 0) table.lines.push_back({static_cast<int>(k / 2), static_cast<int>(k)});
  }
  table.point_data = {{"size_um", size}, {"bead_id", id}, {"displacement_um", displacement}};
  table.line_data = {{"gap_um", std::vector<double>(table.lines.size(), 0.1)},
                     {"state", std::vector<std::int64_t>(table.lines.size(), -2)}};
  table.text_fields = {{"length_unit", "µm"},
                       {"provenance", "{\"command\":\"a < b && c\",\n\"x\":\"\\\"\"}"}};
  table.number_fields = {{"strain", 1.0 / 3.0}, {"specimen_height_um", 4050.0}};
  return table;
}

TEST(PolyData, RoundTripIsExact) {
  const ScratchFolder scratch;
  for (const std::size_t count : {1UL, 2UL, 5000UL}) {
    const PolyTable written = table_of(count);
    write_polydata(scratch / "a.vtp", written);
    const PolyTable read = read_polydata(scratch / "a.vtp");
    EXPECT_EQ(read.points, written.points);
    EXPECT_EQ(read.lines, written.lines);
    EXPECT_EQ(read.point_data, written.point_data);
    EXPECT_EQ(read.line_data, written.line_data);
    EXPECT_EQ(read.text_fields, written.text_fields);
    EXPECT_EQ(read.number_fields, written.number_fields);
  }
}

TEST(PolyData, EqualTablesGiveEqualBytes) {
  const ScratchFolder scratch;
  write_polydata(scratch / "a.vtp", table_of(700));
  write_polydata(scratch / "another_name.vtp", table_of(700));
  EXPECT_EQ(read_text(scratch / "a.vtp"), read_text(scratch / "another_name.vtp"));
}

TEST(PolyData, NumbersTakeIntegersButNotTheReverse) {
  const PolyTable table = table_of(3);
  EXPECT_EQ(numbers(table, false, "state", "f"), (std::vector<double>{-2, -2}));
  EXPECT_EQ(vectors(table, true, "displacement_um", "f").size(), 3u);
  EXPECT_THROW(integers(table, true, "size_um", "f"), BadInput);
  EXPECT_THROW(numbers(table, true, "displacement_um", "f"), BadInput);
  EXPECT_THROW(vectors(table, true, "bead_id", "f"), BadInput);
  EXPECT_THROW(numbers(table, true, "gap_um", "f"), BadInput);  // of lines, not of points
}

TEST(PolyData, TruncatedFileIsBadInput) {
  const ScratchFolder scratch;
  write_polydata(scratch / "whole.vtp", table_of(2000));
  const std::string whole = read_text(scratch / "whole.vtp");
  for (const double share : {0.0, 0.001, 0.01, 0.03, 0.1, 0.3, 0.5, 0.9, 0.999}) {
    const auto length = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
    write_text(scratch / "cut.vtp", whole.substr(0, length));
    EXPECT_THROW(read_polydata(scratch / "cut.vtp"), BadInput) << length;
    if (share > 0.95) continue;  // padding: VTK itself takes the file for whole
    write_text(scratch / "hole.vtp", whole.substr(0, length) + "\n</VTKFile>\n");
    EXPECT_THROW(read_polydata(scratch / "hole.vtp"), BadInput) << length;
  }
}

TEST(PolyData, DamagedFileIsBadInputAndSilent) {
  const ScratchFolder scratch;
  write_polydata(scratch / "whole.vtp", table_of(2000));
  const std::string whole = read_text(scratch / "whole.vtp");
  ::testing::internal::CaptureStderr();
  for (const std::string text :
       {"", "x_um,y_um\n1,2\n", "<?xml version=\"1.0\"?>\n<html></html>", "<VTKFile></VTKFile>"}) {
    write_text(scratch / "no.vtp", text);
    EXPECT_THROW(read_polydata(scratch / "no.vtp"), BadInput) << text;
  }
  for (std::size_t at = whole.find("<AppendedData") + 60; at < whole.size() - 40; at += whole.size() / 7) {
    std::string damaged = whole;
    for (std::size_t k = 0; k < 16; ++k) damaged[at + k] = damaged[at + k] == 'A' ? 'B' : 'A';
    write_text(scratch / "damaged.vtp", damaged);
    EXPECT_THROW(read_polydata(scratch / "damaged.vtp"), BadInput) << at;
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(PolyData, MissingFileAndFolderAreBadInput) {
  const ScratchFolder scratch;
  EXPECT_THROW(read_polydata(scratch / "absent.vtp"), BadInput);
  EXPECT_THROW(read_polydata(scratch.path()), BadInput);
}

/// The corners of a file made by hand, with other types than the writer's.
TEST(PolyData, ReadsOtherWritersTypesAndRejectsOtherLines) {
  const ScratchFolder scratch;
  const auto file = [](const std::string& offsets, const std::string& connectivity) {
    return "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData>"
           "<Piece NumberOfPoints=\"3\" NumberOfVerts=\"0\" NumberOfLines=\"1\" NumberOfStrips=\"0\" "
           "NumberOfPolys=\"0\">"
           "<PointData><DataArray type=\"UInt8\" Name=\"boundary\" format=\"ascii\">0 1 1</DataArray>"
           "<DataArray type=\"Float32\" Name=\"size\" format=\"ascii\">0.5 1 "
           "2</DataArray></PointData><CellData/>"
           "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 2 "
           "0</DataArray></Points>"
           "<Lines><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" +
           connectivity + "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">" +
           offsets + "</DataArray></Lines></Piece></PolyData></VTKFile>\n";
  };
  write_text(scratch / "good.vtp", file("2", "0 2"));
  const PolyTable table = read_polydata(scratch / "good.vtp");
  EXPECT_EQ(table.points.at(2), Vec3(0, 2, 0));
  EXPECT_EQ(table.lines, (std::vector<std::array<int, 2>>{{0, 2}}));
  EXPECT_EQ(integers(table, true, "boundary", "f"), (std::vector<std::int64_t>{0, 1, 1}));
  EXPECT_EQ(numbers(table, true, "size", "f"), (std::vector<double>{0.5, 1, 2}));

  write_text(scratch / "three.vtp", file("3", "0 1 2"));
  EXPECT_THROW(read_polydata(scratch / "three.vtp"), BadInput);
  write_text(scratch / "beyond.vtp", file("2", "0 7"));
  EXPECT_THROW(read_polydata(scratch / "beyond.vtp"), BadInput);
}

}  // namespace
}  // namespace pendular
