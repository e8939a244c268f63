# The bonded packing in the current folder in ESyS-Particle: mpirun -np WORKERS+1 esysparticle esys_particle.py WORKERS
#
# Rotational bonds (normal and shear; bending and torsion off, strength out of reach), frictional contacts of pairs
# without a bond, elastic platens; undamped. Reads law.json, beads.txt and bonds.txt as
# yade.py does; writes speed.json. One process more than WORKERS waits as master.

import json
import sys
import time

from esys.lsm import LsmMpi, NRotElasticWallPrms, RotBondPrms, RotFrictionPrms, RotSphere, Runnable
from esys.lsm.geometry import TaggedIdConnection
from esys.lsm.util import BoundingBox, Vec3


class Clock(Runnable):
    """Notes the time at the end of the warm-up and of the run, and moves the lower platen."""

    def __init__(self, sim, law):
        Runnable.__init__(self)
        self.sim, self.law, self.step, self.times = sim, law, 0, {}

    def run(self):
        self.times[self.step] = time.perf_counter()
        self.sim.moveWallBy("bottom", Vec3(0, 0, self.law["speed_m_per_s"] * self.law["time_step_s"]))
        self.step += 1


def rows(name, kind):
    with open(name) as lines:
        return [[kind(word) for word in line.split()] for line in lines if not line.startswith("#")]


with open("law.json") as file:
    law = json.load(file)
beads, bonds = rows("beads.txt", float), rows("bonds.txt", int)
largest = max(b[3] for b in beads)
low = [min(b[axis] - b[3] for b in beads) for axis in range(3)]
high = [max(b[axis] + b[3] for b in beads) for axis in range(3)]

workers = int(sys.argv[1])
sim = LsmMpi(workers, [workers, 1, 1])
sim.initNeighbourSearch(particleType="RotSphere", gridSpacing=2.6 * largest, verletDist=0.2 * largest)
sim.setNumTimeSteps(law["warm_up_steps"] + law["steps"])
sim.setTimeStepSize(law["time_step_s"])
margin = 2 * largest
sim.setSpatialDomain(BoundingBox(Vec3(*[x - margin for x in low]), Vec3(*[x + margin for x in high])))
volume = 4.0 / 3.0 * 3.141592653589793
sim.createParticles([
    RotSphere(id=k, posn=Vec3(x, y, z), radius=r, mass=law["density_kg_m3"] * volume * r**3)
    for k, (x, y, z, r) in enumerate(beads)])
sim.createConnections([TaggedIdConnection(i, j, 0) for i, j in bonds])
sim.createWall("bottom", Vec3(0, 0, low[2]), Vec3(0, 0, 1))
sim.createWall("top", Vec3(0, 0, high[2]), Vec3(0, 0, -1))
out_of_reach = 1e30
sim.createInteractionGroup(RotBondPrms(
    name="bonds", normalK=law["kn_n_per_m"], shearK=law["kt_n_per_m"], torsionK=0.0, bendingK=0.0,
    normalBrkForce=out_of_reach, shearBrkForce=out_of_reach, torsionBrkForce=out_of_reach,
    bendingBrkForce=out_of_reach, tag=0, scaling=False))
sim.createInteractionGroup(RotFrictionPrms(
    name="contacts", normalK=law["k_glass_n_per_m"], dynamicMu=law["friction"], staticMu=law["friction"],
    shearK=law["kt_glass_n_per_m"], scaling=False))
sim.createExclusion("bonds", "contacts")
for wall in "bottom", "top":
    sim.createInteractionGroup(NRotElasticWallPrms(
        name=wall + "_touches", wallName=wall, normalK=law["k_glass_n_per_m"]))
clock = Clock(sim, law)
sim.addPreTimeStepRunnable(clock)
sim.run()
first, last = law["warm_up_steps"], max(clock.times)
with open("speed.json", "w") as speed:
    json.dump({"particle_steps_per_second": len(beads) * (last - first) / (clock.times[last] - clock.times[first])}, speed)
