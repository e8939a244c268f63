#include "run_folder/run_folder.h"

#include <algorithm>

#include "base/error.h"
#include "base/path_kind.h"

namespace pendular {

std::vector<fs::path> sorted_entries(const fs::path& folder, const std::string& start,
                                     const std::string& extension) {
  std::vector<fs::path> found;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(start, 0) == 0 && entry.path().extension() == extension) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

RunFolder read_run_curves(const fs::path& path) {
  if (!is_folder(path)) bad_input("{}: found no folder, expected a run folder", path.string());
  RunFolder run;
  run.path = path;
  const fs::path curve = path / run_file::kCurve;
  const auto rows = read_curve(curve, {&CurveRow::strain, &CurveRow::stress});
  if (rows.size() < 2) bad_input("{}: found {} rows, expected at least 2", curve.string(), rows.size());
  for (const auto& row : rows) run.strain.push_back(row.strain), run.stress.push_back(row.stress);
  if (is_there(path / run_file::kEvents)) run.break_strain = read_break_strains(path / run_file::kEvents);
  run.result = read_result(path / run_file::kResult);
  run.frames = frame_files(path);
  return run;
}

RunFolder read_run_folder(const fs::path& path) {
  RunFolder run = read_run_curves(path);
  if (run.frames.empty())
    bad_input("{}: found no frame_*.vtp, expected at least one", (path / run_file::kFrames).string());
  return run;
}

std::vector<fs::path> realisations(const fs::path& path) {
  if (!is_folder(path)) bad_input("{}: found no folder, expected a run folder", path.string());
  if (is_there(path / run_file::kCurve)) return {path};
  auto found = sorted_entries(path, "realisation_", "");
  if (found.empty())
    bad_input("{}: found neither curve.csv nor realisation_* folders, expected a run folder", path.string());
  return found;
}

std::vector<fs::path> picture_inputs(const fs::path& path) {
  std::vector<fs::path> inputs;
  for (const fs::path& run : realisations(path))
    for (const char* name : {run_file::kCurve, run_file::kEvents, run_file::kResult, run_file::kFrames})
      if (is_there(run / name)) inputs.push_back(run / name);
  return inputs;
}

}  // namespace pendular
