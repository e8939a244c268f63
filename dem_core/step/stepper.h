#pragma once

#include <atomic>
#include <functional>
#include <vector>

#include "base/parallel.h"
#include "dem_core/simulation.h"
#include "dem_core/step/quanta.h"
#include "dem_core/step/step_tables.h"
#include "dem_core/step/stepping.h"

namespace pendular::dem_core {

/// Advances a simulation step by step, fast: vector kernels over tables of pairs and beads, which are kept in
/// the order of their place in space. Chunks of neighbouring beads and their pairs are what threads share:
/// each thread has its own, which follow each other and so meet those of others along a plane only. In a step
/// it first advances their pairs and adds their forces to sums of each chunk's own, then collects the sums
/// for its beads and moves them. So what a core has written it reads again itself. Sums are of whole numbers
/// (Quanta): the same for any number of threads and whenever pairs are listed.
///
/// The simulation's platens, sums, events and step count are always true; its beads and pairs are after
/// store(). The tables are made anew from the simulation alone, so building a stepper anew changes no result.
class Stepper : public Stepping {
 public:
  explicit Stepper(Simulation& simulation);

  /// One time step. Pairs are listed anew where a bead or platen may have moved by its margin.
  void step();

  void change_bonds(const BondEvolution& evolution, double elapsed) override;
  void store() override;

  /// Reads the simulation anew, where it was changed from outside.
  void load();

  /// Of all beads, J.
  double kinetic_energy() const;

  /// Brings all beads and the moving platen to rest as if the last step had found them so: at the places that
  /// pairs remember. Books what that takes as Work::halted.
  void halt();

  /// Gives the moving platen a speed (m/s) and the beads, at rest, the velocity of a field over their places,
  /// as if the last step had done so. Books what that brings as Work::halted, negative.
  void set_in_motion(double platen, const std::function<Vec3(const Vec3&)>& velocity);

 private:
  void order_beads();
  void load_beads();
  void cut_chunks();
  void load_pairs();
  void load_pair(const Chunk& chunk, std::size_t at);
  void share_sums();
  void find_beads_near_platens();
  void store_platen(const AlignedVector<PlatenBlock>& near, Platen& platen);
  void store_pair(const Chunk& chunk, std::size_t at);
  ContactBlock* contact_of(const Chunk& chunk, std::size_t at);
  BendBlock* bend_of(std::size_t at);
  void share_chunks();
  void advance_share(std::size_t share);
  void move_share(std::size_t share);
  void advance_chunk(std::size_t c);
  void press_platens(Chunk& chunk);
  template <typename Function>
  void for_pairs(const Function& f);
  /// A pair of the simulation, and where the table has it.
  struct PlaceOfPair {
    std::int64_t pair;
    const Chunk* chunk;
    std::size_t at;
    bool operator<(const PlaceOfPair& other) const { return pair < other.pair; }
  };
  std::vector<PlaceOfPair> bonded() const;
  template <typename Change>
  void change_pair(const Chunk& chunk, std::size_t at, const Change& change);
  void break_bonds();
  void add_up();
  BeadMotion motion(std::size_t row) const;
  bool listing_due() const;

  /// Chunks of a thread: those that follow each other.
  struct Share {
    std::size_t first, last;
  };
  /// Whether a chunk's pairs are taken in this step. In a line of memory of its own, which moves between
  /// cores only where a thread takes what another has left.
  struct alignas(64) Taken {
    std::atomic<bool> flag{false};
  };

  Simulation& simulation_;
  Quanta quanta_;
  std::vector<std::size_t> bead_of_;   ///< row of the bead table → bead
  std::vector<std::int32_t> row_of_;   ///< bead → row
  std::vector<std::int64_t> pair_of_;  ///< place in the pair table → pair, or −1: fills up
  PairTable pairs_;
  BeadTable beads_;
  std::vector<Chunk> chunks_;
  std::vector<Share> shares_;  ///< one per thread
  std::vector<Taken> taken_;   ///< of each chunk
};

}  // namespace pendular::dem_core
