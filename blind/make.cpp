#include "blind/make.h"

#include "base/error.h"
#include "base/progress.h"
#include "blind/engine_run.h"
#include "blind/processes.h"
#include "sweep/estimate.h"

namespace pendular::blind {
namespace {

constexpr std::size_t kMostTold = 3;

/// Cases that are asked for, by their numbers in the plan, and those of them that are not there.
struct Ahead {
  std::size_t asked = 0;
  std::vector<std::size_t> missing;
};

Ahead ahead(const CaseFolders& folders, const Split& split, std::size_t packing,
            const std::vector<CasePlan>& plans) {
  Ahead found;
  for (std::size_t k = 0; k < plans.size(); ++k) {
    if (packing != 0 && plans[k].packing + 1 != packing) continue;
    ++found.asked;
    if (!is_made(folders, split, plans[k])) found.missing.push_back(k);
  }
  return found;
}

void write_seals(const CaseFolders& folders, const Split& split, const std::vector<CasePlan>& plans) {
  std::string text = "case,sha256\n";
  for (const auto& plan : plans)
    if (is_made(folders, split, plan))
      text += fmt::format("{},{}\n", plan.name, published_seal(folders.open(plan.name)));
  write_text(folders.seals(), text);
}

}  // namespace

std::size_t make_split(const CaseFolders& folders, const Split& split, std::size_t packing, std::size_t cores,
                       const std::function<Command(std::size_t number)>& command_of) {
  const auto plans = plan_of(split);
  const auto [asked, numbers] = ahead(folders, split, packing, plans);
  for (const std::size_t number : numbers)
    if (!plans[number].engine.empty()) require_installed(find_engine(plans[number].engine, split.name));
  for (const char* inner : {"work", "cases", "sealed"}) make_inner_folder(folders.root / inner);
  std::vector<Job> jobs;
  for (const std::size_t number : numbers)
    jobs.push_back({command_of(number), folders.log(plans[number].name)});
  Progress progress("blind make", static_cast<double>(asked));
  std::size_t made = asked - numbers.size(), failed = 0;
  std::string told;
  progress.update(static_cast<double>(made));
  run_jobs(jobs, cores, [&](std::size_t k, int status) {
    status == 0 ? ++made : ++failed;
    if (status == 0)
      fs::remove(jobs[k].log);
    else if (failed <= kMostTold)
      told += fmt::format("; {}: {}", plans[numbers[k]].name, last_line(jobs[k].log));
    progress.update(static_cast<double>(made + failed),
                    fmt::format("{} of {} cases, {} failed", made, asked, failed));
  });
  if (failed > 0)
    throw ComputationFailed(fmt::format("{} of {} cases could not be made{}{}", failed, asked, told,
                                        failed > kMostTold ? "; …" : ""));
  write_seals(folders, split, plans);
  fs::remove_all(folders.root / "work");
  return asked;
}

std::string work_ahead(const CaseFolders& folders, const Split& split, std::size_t packing,
                       std::size_t cores) {
  const auto plans = plan_of(split);
  const auto [asked, numbers] = ahead(folders, split, packing, plans);
  double steps = 0.0;
  for (const std::size_t number : numbers) steps += expected_particle_steps(split, plans[number]);
  const double seconds = steps / sweep::kStatedRate;
  const std::size_t packings = packing == 0 ? split.packings.size() : 1;
  return fmt::format(
      "{}: {} cases on {} packing{}, {} of them made; {} to make: about {:.3g} particle-steps, {:.0f} min of "
      "one core, {:.0f} min on {} cores",
      split.name, asked, packings, packings == 1 ? "" : "s", asked - numbers.size(), numbers.size(), steps,
      seconds / 60.0, seconds / 60.0 / static_cast<double>(cores), cores);
}

}  // namespace pendular::blind
