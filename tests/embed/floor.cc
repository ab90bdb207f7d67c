// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/exemplar.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace Exemplar;

namespace
{
  // k/2 depth^2 of the nodes below a height: a term of one's own. The energy and its gradient are continuous at the
  // height; a jump there would let line searches stall.
  class Floor : public PotentialTerm
  {
  public:
    Floor(const double height, const double stiffness) : height(height), stiffness(stiffness) {}

    // Messages and summary.json call it so.
    std::string
    name() const override
    {
      return "floor";
    }

    // The matrix's pattern and the unknowns; called again when handles take or let go of nodes.
    void
    attach(const SymmetricPattern &new_pattern, const FreeDofs &dofs) override
    {
      pattern   = &new_pattern;
      free_dofs = &dofs;
    }

    // Called at each trial of a line search.
    void
    add(const TermPoint &at, ElasticSums &sums) override
    {
      // degree of freedom 3 i + 2 is the z of node i; held ones count, too: their gradient is the reaction
      for (unsigned int dof = 2; dof < at.positions.size(); dof += 3)
        if (const double depth = std::min(at.positions[dof] - height, 0.); depth < 0.)
        {
          sums->energy += 0.5 * stiffness * depth * depth; // [J]
          sums->gradient[dof] += stiffness * depth; // its derivative, which is minus the force [N]
          // by node, the magnitude of that force: residuals are measured by the sum of all
          sums->force_scale[dof / 3] -= stiffness * depth;
        }
    }

    // Called when a matrix is made. The last argument is for energies of the weights.
    void
    add_tangent(const TermPoint     &at,
                Tangent              kind,
                std::vector<double> &values,
                std::vector<double> &) override
    {
      (void) kind; // of a term that is not convex, Tangent::convex must leave out what is negative
      for (unsigned int dof = 2; dof < at.positions.size(); dof += 3)
        // negative where a handle holds the node: no unknown, so no row of the matrix
        if (const int i = free_dofs->free_index(dof); at.positions[dof] < height && i >= 0)
          values[pattern->position(i, i)] += stiffness; // [N/m]; the lower triangle, i >= j
    }

    // In bytes, for summary.json.
    std::size_t
    memory_consumption() const override
    {
      return sizeof(*this);
    }

  private:
    const double            height, stiffness;
    const SymmetricPattern *pattern   = nullptr; // these two outlive the term
    const FreeDofs         *free_dofs = nullptr;
  };
} // namespace

// A bar, held at one end, sags onto a soft floor. Prints its least height and what is left of the
// forces of the free nodes over those of the held ones.
int
main()
{
  std::vector<dealii::Point<3>>            nodes;
  std::vector<std::array<unsigned int, 4>> cells;
  for (unsigned int i = 0; i < 20; ++i) // 5 x 2 x 2, x fastest
    nodes.emplace_back(i % 5, i / 5 % 2, i / 10);
  for (unsigned int a = 0; a < 4; ++a)
    for (const auto &[b, c] :
         { std::pair(1, 6), { 6, 5 }, { 5, 15 }, { 15, 10 }, { 10, 11 }, { 11, 1 } })
      cells.push_back({ { a, a + b, a + c, a + 16 } });
  SceneParameters scene;
  scene.scene         = SceneKind::statics;
  scene.handles       = { { "left", { "box 0 -1 -1 0 2 2" } } };
  scene.loads.gravity = { { 0., 0., -10. } };
  Problem problem(scene, { make_msh(nodes, cells), {}, {} });
  // a function, as the laboratory below makes a term of its own
  problem.add_term([] { return std::make_unique<Floor>(-0.02, 1e6); });
  while (problem.state.step < problem.time_axis.n_steps())
    if (!is_success(problem.advance().status))
      return 1;
  const Vector gradient = problem.laboratory().evaluate(problem.laboratory().here()).gradient;
  double       least = 0., free_force = 0., held_force = 0.;
  for (unsigned int node = 0; node < nodes.size(); ++node)
    for (unsigned int c = 0; c < 3; ++c)
    {
      double &greatest = nodes[node][0] == 0. ? held_force : free_force;
      greatest         = std::max(greatest, std::abs(gradient[3 * node + c]));
      least            = std::min(least, problem.state.positions[3 * node + 2]);
    }
  std::printf("%.6f %g\n", least, free_force / held_force);
}
