// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_state_h
#define exemplar_state_h

#include <exemplar/algebra/vector.h>

#include <array>
#include <vector>

namespace Exemplar
{
  class Mesh;

  /// What a step starts from and ends in. Each field is named once more in serialize(), and once in
  /// nodal_fields() if it belongs to the nodes: whatever copies, sends, saves or compares states knows
  /// it by these.
  struct State
  {
    unsigned int        step = 0;
    double              time = 0.;           ///< [s]
    Vector              positions;           ///< [m], by degree of freedom 3 i + c
    Vector              velocities;          ///< [m/s]; empty unless dynamic
    Vector              previous_positions;  ///< before the last step; empty unless
    Vector              previous_velocities; ///< the time scheme has two steps
    double              previous_step = 0.;  ///< size of the last step [s]; 0: none
    std::vector<double> weights;             ///< of the examples; empty without examples
    std::vector<double> previous_weights;    ///< as previous_positions
    std::vector<double> multipliers;         ///< of each region's sum of weights to find [J]
    std::vector<double> history; ///< what laws remember, equally many numbers a cell; may be empty
    double              dissipated = 0.; ///< by what remembers, since the first step [J]

    std::array<Vector *, 4>
    nodal_fields()
    {
      return { { &positions, &velocities, &previous_positions, &previous_velocities } };
    }

    /// For boost's archives.
    template <typename Archive>
    void
    serialize(Archive &archive, const unsigned int /*version*/)
    {
      archive &step &time &positions &velocities &previous_positions &previous_velocities
          &previous_step &weights &previous_weights &multipliers &history &dissipated;
    }
  };

  bool
  operator==(const State &a, const State &b);

  /// The state of the whole body, at the root of those who share it; all of them must call this.
  State
  whole(const Mesh &mesh, State state);

  /// What a process has of a whole state; talks to nobody.
  State
  part(const Mesh &mesh, State state);
} // namespace Exemplar

#endif
