#include "diagnosis_report/report_folder.h"

#include <nlohmann/json.hpp>

#include <cctype>

#include "base/interrupt.h"
#include "diagnosis_report/cause_figures.h"
#include "diagnosis_report/gap_figures.h"
#include "diagnosis_report/json.h"
#include "diagnosis_report/outcome_figures.h"
#include "diagnosis_report/overlay_figures.h"
#include "diagnosis_report/page.h"
#include "diagnosis_report/place_figures.h"
#include "diagnosis_report/tables.h"

namespace pendular::diagnosis_report {
namespace {

using diagnosis::Diagnosis;

constexpr std::size_t kLongestName = 60;

/// A name that any file system takes.
std::string file_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
  return name.substr(0, kLongestName);
}

/// Writes figures and tables into the folder.
class Files {
 public:
  Files(const Desk& desk, const Diagnosis& diagnosis)
      : desk_(desk),
        comment_(to_comment(diagnosis.provenance)),
        metadata_(pendular::to_json(diagnosis.provenance)
                      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) {}

  void keep(const Table& table) const {
    write_text(desk_.out / (file_name(table.name) + ".csv"), comment_ + to_csv(table));
  }
  void keep(const Drawn& figure, std::vector<viz::ReportPicture>& section) const {
    stop_if_interrupted();
    const fs::path picture = desk_.out / (file_name(figure.data.name) + ".png");
    write_png(picture, figure.image, metadata_);
    keep(figure.data);
    for (const Table& table : figure.more) keep(table);
    section.push_back({picture, figure.caption});
  }
  template <typename Figures>
  void keep_all(const Figures& figures, std::vector<viz::ReportPicture>& section) const {
    for (const Drawn& figure : figures) keep(figure, section);
  }
  void keep(const std::optional<Drawn>& figure, std::vector<viz::ReportPicture>& section) const {
    if (figure) keep(*figure, section);
  }

 private:
  const Desk& desk_;
  std::string comment_, metadata_;
};

Pictures keep_figures(const Desk& desk, const Diagnosis& d, const Files& files) {
  Pictures pictures;
  files.keep_all(gap_figures(desk.display, d), pictures.where);
  files.keep_all(place_figures(desk.display, d.places), pictures.where);
  files.keep_all(overlay_figures(desk.display, d), pictures.overlays);
  files.keep(hypothesis_figure(desk.display, d), pictures.which);
  files.keep_all(magnitude_figures(desk.display, d), pictures.which);
  files.keep(signature_figure(desk.display, d), pictures.which);
  files.keep(separation_figure(desk.display, d), pictures.which);
  files.keep(pull_figure(desk.display, d), pictures.which);
  files.keep(goodness_figure(desk.display, d), pictures.which);
  files.keep(shrinkage_figure(desk.display, d), pictures.how_far);
  files.keep(next_figure(desk.display, d.next), pictures.next);
  return pictures;
}

}  // namespace

void write_report_folder(const Desk& desk, const Diagnosis& d) {
  make_folder(desk.out);
  const Files files(desk, d);
  const Pictures pictures = keep_figures(desk, d, files);
  for (const Table& table : {gap_table(d), share_table(d), hypothesis_table(d), noise_table(d),
                             excluded_table(d), promise_table(d), reliability_table(d), next_table(d.next),
                             next_effects_table(d.next), ledger_table(d)})
    files.keep(table);
  for (const auto& place : d.places)
    write_polydata(desk.out / (file_name("place_" + place.observation) + ".vtp"), place_polydata(place));
  viz::write_report(desk.out / "report.html", page_of(d, pictures));
  write_text(desk.out / "diagnosis.json",
             to_json(d).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace pendular::diagnosis_report
