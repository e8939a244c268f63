#include "packing/exchange_run.h"

#include <gtest/gtest.h>
#include <vtkCell.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkHDFReader.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUtilities.h>

#include <map>
#include <sstream>

#include "base/error.h"
#include "packing/polydata.h"
#include "packing/vtp.h"
#include "scratch.h"
#include "small_packing.h"

namespace pendular {
namespace {

using test::ScratchFolder;
using test::small_packing;

/// A frame of a run as `pendular compress` writes it, every array its own.
PolyTable frame(double strain) {
  PolyTable table;
  table.points = {Vec3(0, 0, 100), Vec3(0, 0, 300 - 100 * strain), Vec3(200, 0, 100)};
  table.lines = {{0, 1}, {0, 2}, {1, 2}};
  table.point_data = {
      {"bead_id", std::vector<std::int64_t>{7, 9, 12}},
      {"diameter_um", std::vector<double>{200, 210, 190}},
      {"displacement_um", std::vector<Vec3>{Vec3::Zero(), Vec3(1, 2, -100 * strain), Vec3::Zero()}},
      {"damage", std::vector<double>{0.0, strain, 0.25}}};
  table.line_data = {{"state", std::vector<std::int64_t>{0, 1, 2}},
                     {"normal_force_n", std::vector<double>{0.125, 0.0, strain}}};
  table.number_fields = {{"strain", strain}, {"stress_pa", 1e6 * strain}};
  table.text_fields = {{"units", "um"}};
  return table;
}

fs::path run_in(const ScratchFolder& scratch) {
  fs::create_directories(scratch / "run" / "frames");
  for (int k = 0; k < 3; ++k)
    write_polydata(scratch / "run" / "frames" / fmt::format("frame_{:04d}.vtp", k), frame(0.01 * k));
  return scratch / "run";
}

TEST(ExchangeRun, ACollectionNamesEveryFrameAtItsStrain) {
  const ScratchFolder scratch;
  const fs::path run = run_in(scratch);
  fs::create_directories(scratch / "a & b");
  for (const fs::path& file : {run / "run.pvd", scratch / "a & b" / "elsewhere.pvd"}) {
    write_pvd(file, run);
    const auto root =
        vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(file.c_str()));
    ASSERT_NE(root, nullptr);
    EXPECT_STREQ(root->GetAttribute("type"), "Collection");
    vtkXMLDataElement* collection = root->FindNestedElementWithName("Collection");
    ASSERT_NE(collection, nullptr);
    ASSERT_EQ(collection->GetNumberOfNestedElements(), 3);
    for (int k = 0; k < 3; ++k) {
      vtkXMLDataElement* set = collection->GetNestedElement(k);
      double time = -1.0;
      set->GetScalarAttribute("timestep", time);
      EXPECT_EQ(time, 0.01 * k);
      vtkNew<vtkXMLPolyDataReader> reader;
      reader->SetFileName((file.parent_path() / set->GetAttribute("file")).c_str());
      reader->Update();
      EXPECT_EQ(reader->GetOutput()->GetNumberOfPoints(), 3);
      EXPECT_EQ(reader->GetOutput()->GetFieldData()->GetArray("strain")->GetTuple1(0), time);
    }
  }
  EXPECT_NE(read_text(run / "run.pvd").find("file=\"frames/frame_0000.vtp\""), std::string::npos);
}

TEST(ExchangeRun, ARunWithoutFramesIsBadInput) {
  const ScratchFolder scratch;
  EXPECT_THROW(write_pvd(scratch / "run.pvd", scratch.path()), BadInput);
  EXPECT_THROW(write_dump(scratch / "run.dump", scratch.path()), BadInput);
  fs::create_directories(scratch / "frames");
  write_packing(scratch / "frames" / "frame_0000.vtp", small_packing());
  EXPECT_THROW(write_pvd(scratch / "run.pvd", scratch.path()), BadInput);
  EXPECT_FALSE(fs::exists(scratch / "run.pvd"));
}

/// A snapshot of a LAMMPS dump: rows by the names of their columns.
struct Snapshot {
  long step = -1;
  double time = -1.0;
  std::array<double, 6> box{};
  std::vector<std::map<std::string, double>> rows;
};

/// Reads a dump by LAMMPS's description of it: items in any order, `what` last.
std::vector<Snapshot> read_dump(const fs::path& path, const std::string& what) {
  std::istringstream in(read_text(path));
  std::vector<Snapshot> found;
  Snapshot now;
  std::size_t count = 0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream head(line);
    std::string item, name;
    head >> item >> name;
    EXPECT_EQ(item, "ITEM:") << line;
    if (name == "TIMESTEP") in >> now.step >> std::ws;
    if (name == "TIME") in >> now.time >> std::ws;
    if (name == "NUMBER") in >> count >> std::ws;
    if (name == "UNITS") std::getline(in, line);
    if (name == "BOX") {
      for (double& edge : now.box) in >> edge;
      in >> std::ws;
    }
    if (name != what) continue;
    std::vector<std::string> columns{std::istream_iterator<std::string>(head), {}};
    for (std::size_t row = 0; row < count; ++row) {
      now.rows.emplace_back();
      for (const auto& column : columns) in >> now.rows.back()[column];
    }
    in >> std::ws;
    found.push_back(now);
    now = {};
  }
  return found;
}

TEST(ExchangeRun, DumpsHoldBeadsAndBondsOfEveryFrame) {
  const ScratchFolder scratch;
  write_dump(scratch / "run.dump", run_in(scratch));
  const auto beads = read_dump(scratch / "run.dump", "ATOMS");
  const auto bonds = read_dump(scratch / "run.bonds.dump", "ENTRIES");
  ASSERT_EQ(beads.size(), 3u);
  ASSERT_EQ(bonds.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(beads[k].step, static_cast<long>(k));
    EXPECT_EQ(bonds[k].step, beads[k].step);
    EXPECT_EQ(beads[k].time, 0.01 * static_cast<double>(k));
    ASSERT_EQ(beads[k].rows.size(), 3u);
    auto second = beads[k].rows[1];
    EXPECT_EQ(second["id"], 9);
    EXPECT_DOUBLE_EQ(second["radius"], 105e-6);
    EXPECT_DOUBLE_EQ(second["z"], 1e-6 * (300 - static_cast<double>(k)));
    EXPECT_DOUBLE_EQ(second["displacement_um_z"], -static_cast<double>(k));
    EXPECT_LE(beads[k].box[0], second["x"] - second["radius"]);
    EXPECT_GE(beads[k].box[5], second["z"] + second["radius"]);
    ASSERT_EQ(bonds[k].rows.size(), 3u);
    auto third = bonds[k].rows[2];
    EXPECT_EQ(third["batom1"], 9);
    EXPECT_EQ(third["batom2"], 12);
    EXPECT_EQ(third["btype"], 3);
    EXPECT_EQ(third["normal_force_n"], 0.01 * static_cast<double>(k));
  }
}

vtkSmartPointer<vtkUnstructuredGrid> read_vtkhdf(const fs::path& path) {
  vtkNew<vtkHDFReader> reader;
  EXPECT_NE(reader->CanReadFile(path.c_str()), 0);
  reader->SetFileName(path.c_str());
  reader->Update();
  return vtkUnstructuredGrid::SafeDownCast(reader->GetOutputAsDataSet());
}

TEST(Vtkhdf, VtkReadsWhatIsWritten) {
  const ScratchFolder scratch;
  const PolyTable table = frame(0.02);
  write_vtkhdf(scratch / "a.vtkhdf", table);
  const auto grid = read_vtkhdf(scratch / "a.vtkhdf");
  ASSERT_NE(grid, nullptr);
  ASSERT_EQ(grid->GetNumberOfPoints(), 3);
  ASSERT_EQ(grid->GetNumberOfCells(), 3);
  for (vtkIdType k = 0; k < 3; ++k) {
    const auto n = static_cast<std::size_t>(k);
    EXPECT_EQ(Vec3(grid->GetPoint(k)), table.points[n]);
    EXPECT_EQ(grid->GetCellType(k), VTK_LINE);
    for (int end = 0; end < 2; ++end)
      EXPECT_EQ(grid->GetCell(k)->GetPointId(end), table.lines[n][static_cast<std::size_t>(end)]);
    EXPECT_EQ(grid->GetPointData()->GetArray("bead_id")->GetTuple1(k),
              integers(table, true, "bead_id", "")[n]);
    EXPECT_EQ(Vec3(grid->GetPointData()->GetArray("displacement_um")->GetTuple3(k)),
              vectors(table, true, "displacement_um", "")[n]);
    EXPECT_EQ(grid->GetCellData()->GetArray("normal_force_n")->GetTuple1(k),
              numbers(table, false, "normal_force_n", "")[n]);
  }
  EXPECT_EQ(grid->GetFieldData()->GetArray("strain")->GetTuple1(0), 0.02);
}

TEST(Vtkhdf, BeadsWithoutBridgesAreVertices) {
  const ScratchFolder scratch;
  Packing packing = small_packing();
  packing.bridges.clear();
  write_vtkhdf(scratch / "a.vtkhdf", to_polydata(packing));
  const auto grid = read_vtkhdf(scratch / "a.vtkhdf");
  ASSERT_NE(grid, nullptr);
  EXPECT_EQ(grid->GetNumberOfCells(), static_cast<vtkIdType>(packing.beads.size()));
  EXPECT_EQ(grid->GetCellType(0), VTK_VERTEX);
}

TEST(Vtkhdf, EqualTablesGiveEqualBytes) {
  const ScratchFolder scratch;
  write_vtkhdf(scratch / "a.vtkhdf", frame(0.01));
  write_vtkhdf(scratch / "b.vtkhdf", frame(0.01));
  EXPECT_EQ(read_text(scratch / "a.vtkhdf"), read_text(scratch / "b.vtkhdf"));
}

}  // namespace
}  // namespace pendular
