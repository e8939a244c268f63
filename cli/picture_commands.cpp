#include "cli/picture_commands.h"

#include <map>

namespace pendular::cli {
namespace {

const std::map<std::string, const char*> kDescriptions = {
    {"demo",
     "The whole chain on the embedded sample: phantom tomogram, beads, packing, compression, pictures, "
     "report"},
    {"phantom", "A synthetic tomogram with known truth: point spread, noise, polymer, container"},
    {"segment",
     "Raw tomogram to beads and candidate bridges.\n"
     "Axis order x, y, z; voxel i has its centre at origin + i x spacing. Lengths in the header of a\n"
     "MetaImage or NRRD count as um (an NRRD may name another unit); TIFF and PNG need --voxel-um."},
    {"track",
     "Beads of one specimen followed from a scan to the next: displacement and local strain.\n"
     "The second scan may be turned by any angle, shifted, and drifted in scale by some 2 %: its frame is\n"
     "found from the beads alone. Displacements are in the frame of the first scan, whose z axis is the\n"
     "specimen's, once rotation, shift and scale are removed. Beads' diameters tell the scale from strain\n"
     "where both tables state their errors, else --strain, else a lateral expansion of 0.3 +- 0.2 of the\n"
     "compression. The table serves `pendular diagnose` as an observation of kind displacements; its column\n"
     "state says which beads came loose. A summary goes beside it as .json: the registration, and the beads\n"
     "that are loose, lost or new. Status 3 where the second scan shows another specimen, or this one in a\n"
     "mirror."},
    {"bridge",
     "Stiffness of one polymer bridge between two beads by finite elements: normal, tangential, bending and\n"
     "twisting, with an estimate of the relative error, and the stress per metre of extension.\n"
     "Values come from the options, else from the sample, else from sample A of Hemmerle et al. 2021. Each "
     "option\n"
     "takes a number, a comma list, or a range FROM:TO:N; all combinations are computed.\n"
     "Without anything: the paper's Table 1 beside this program."},
    {"render", "Off-screen pictures, a film of the failure and a report of a run folder"},
    {"pipette",
     "Micropipette test of one bridge: images to force, displacement and stiffness.\n"
     "The wafer with the fixed bead is moved; the free bead hangs on the pipette, whose deflection times "
     "its\n"
     "stiffness is the force. Writes time_s,displacement_um,force_n,score,used, and beside it the stiffness "
     "with\n"
     "its interval (.json) and a plot (.png, .pdf). Positions in the image are in pixels, x to the right, y "
     "down, "
     "the\n"
     "upper left pixel at (0, 0). Without a linear range the curve is kept, the stiffness is null and the "
     "exit\n"
     "status is 3."},
    {"reproduce",
     "Figures and numbers of Hemmerle et al. 2021 beside this program's: makes the sweeps of a folder\n"
     "(samples/hemmerle2021) and writes report.md, pictures, and the tables behind them."},
    {"diagnose",
     "Where simulation and experiment part, which effect causes it, and how far it shrinks once that is "
     "added.\n"
     "Reads an experiment file with its observations; writes diagnosis.json, report.html, figures and "
     "tables.\n"
     "The same command goes on where it stopped; runs are kept and shared by content (--store)."},
};

}  // namespace

bool is_picture_command(const std::string& name) {
  return kDescriptions.count(name) > 0;
}

CLI::App* add_picture_command(CLI::App& app, const std::string& name) {
  return app.add_subcommand(name, kDescriptions.at(name));
}

}  // namespace pendular::cli
