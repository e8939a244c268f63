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
#include "viz/gnuplot.h"

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

/// Writes tables and pictures into the folder; charts are drawn together.
class Files {
 public:
  Files(const fs::path& out, const Diagnosis& diagnosis)
      : out_(out),
        comment_(to_comment(diagnosis.provenance)),
        metadata_(pendular::to_json(diagnosis.provenance)
                      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)) {}

  void keep(const Table& table) const {
    write_text(out_ / (file_name(table.name) + ".csv"), comment_ + to_csv(table));
  }
  void keep(const Drawn& figure, std::vector<viz::ReportPicture>& section) {
    stop_if_interrupted();
    const auto file = [&](const char* extension) { return out_ / (file_name(figure.data.name) + extension); };
    if (const auto* chart = std::get_if<viz::Figure>(&figure.picture)) {
      charts_.push_back({*chart, {file(".png"), file(".pdf"), file(".svg")}});
      section.push_back({file(".svg"), figure.caption});
    } else {
      write_png(file(".png"), std::get<viz::Image>(figure.picture), metadata_);
      section.push_back({file(".png"), figure.caption});
    }
    keep(figure.data);
    for (const Table& table : figure.more) keep(table);
  }
  template <typename Figures>
  void keep_all(const Figures& figures, std::vector<viz::ReportPicture>& section) {
    for (const Drawn& figure : figures) keep(figure, section);
  }
  void keep(const std::optional<Drawn>& figure, std::vector<viz::ReportPicture>& section) {
    if (figure) keep(*figure, section);
  }
  /// The charts that were kept.
  viz::ChartsInWork draw_charts() const { return {charts_, metadata_}; }

 private:
  fs::path out_;
  std::string comment_, metadata_;
  std::vector<viz::FigureFiles> charts_;
};

Pictures keep_charts(const Diagnosis& d, Files& files) {
  Pictures pictures;
  files.keep_all(gap_figures(d), pictures.where);
  files.keep_all(overlay_figures(d), pictures.overlays);
  files.keep(hypothesis_figure(d), pictures.which);
  files.keep_all(magnitude_figures(d), pictures.which);
  files.keep(signature_figure(d), pictures.which);
  files.keep(separation_figure(d), pictures.which);
  files.keep(pull_figure(d), pictures.which);
  files.keep(chi_squared_figure(d), pictures.which);
  files.keep(shrinkage_figure(d), pictures.how_far);
  files.keep(next_figure(d.next), pictures.next);
  return pictures;
}

}  // namespace

void write_report_folder(const fs::path& out, const Diagnosis& d) {
  make_folder(out);
  Files files(out, d);
  Pictures pictures = keep_charts(d, files);
  viz::ChartsInWork charts = files.draw_charts();
  for (const Table& table : {gap_table(d), share_table(d), hypothesis_table(d), noise_table(d),
                             excluded_table(d), unseen_table(d), promise_table(d), reliability_table(d),
                             next_table(d.next), next_effects_table(d.next), ledger_table(d)})
    files.keep(table);
  for (const auto& place : d.places)
    write_polydata(out / (file_name("place_" + place.observation) + ".vtp"), place_polydata(place));
  write_text(out / "diagnosis.json",
             to_json(d).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  // Where pictures cannot be drawn, the numbers are there.
  files.keep_all(place_figures(d.places), pictures.where);
  charts.write();
  viz::write_report(out / "report.html", page_of(d, pictures));
}

}  // namespace pendular::diagnosis_report
