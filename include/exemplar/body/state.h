// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_state_h
#define exemplar_state_h

#include <exemplar/algebra/vector.h>

#include <array>
#include <vector>

namespace Exemplar
{
  class Mesh;

  /// The state before and after a step. Each field is also named in serialize(), and in
  /// nodal_fields() if it belongs to the nodes: all code that copies, sends, saves or compares
  /// states uses these.
  struct State
  {
    unsigned int        step = 0;
    double              time = 0.;           ///< [s]
    Vector              positions;           ///< [m], by degree of freedom 3 i + c
    Vector              velocities;          ///< [m/s]; empty unless dynamic
    Vector              previous_positions;  ///< before the last step; empty unless
    Vector              previous_velocities; ///< the time scheme has two steps
    double              previous_step = 0.;  ///< size of the last step [s]; 0: none
    std::vector<double> weights;             ///< weights of the examples; empty without
    std::vector<double> previous_weights;    ///< before the last step, as previous_positions
    std::vector<double> multipliers;         ///< multipliers of regions' sums of weights [J]
    std::vector<double> history;         ///< history variables, equally many a cell; may be empty
    double              dissipated = 0.; ///< energy dissipated since the first step [J]

    std::array<Vector *, 4>
    nodal_fields()
    {
      return { { &positions, &velocities, &previous_positions, &previous_velocities } };
    }

    /// Serialise all fields by boost's archives.
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

  /// The state of the whole body, at the root. Collective.
  State
  whole(const Mesh &mesh, State state);

  /// The part of a whole state at a process' nodes and cells; no communication.
  State
  part(const Mesh &mesh, State state);
} // namespace Exemplar

#endif
