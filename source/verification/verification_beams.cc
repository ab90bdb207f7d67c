// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/verification/verification.h>
#include <exemplar/verification/verification_scene.h>

#include <fmt/core.h>

#include <cmath>

// Beams. Linear tetrahedra are too stiff in bending, so that cases use three meshes, each with
// cells of half the size, for the order and the limit.

namespace Exemplar::Verification
{
  namespace
  {
    // A beam of height 1 and width 1/4 that bends in the plane y = const. With Poisson's ratio 0
    // nothing moves along y: one cell across is enough, and y is held.
    constexpr double width = 0.25, E = 1e6, I = width / 12.;

    std::string
    beam(const double slenderness, const unsigned int cells_of_height)
    {
      const auto nx = static_cast<unsigned int>(slenderness) * cells_of_height;
      return box({ { slenderness, width, 1. } }, { { nx, 1, cells_of_height } })
             + section("Material", set("Young's modulus", E) + set("Poisson's ratio", 0.));
    }

    const std::string clamp_and_plane
        = named_sections("Handles",
                         { { "end", set("Select", "boundary 1") },
                           { "front", set("Select", "boundary 3") + set("Components", "y") },
                           { "back", set("Select", "boundary 4") + set("Components", "y") } });

    std::string
    increments(const unsigned int n)
    {
      return section("Time", set("Increments", fmt::format("{}", n)));
    }

    dealii::Tensor<1, 3>
    cantilever_tip(const double slenderness, const unsigned int alpha, const unsigned int cells)
    {
      const double force = alpha * E * I / (slenderness * slenderness);
      Scene        scene(set("Scene", "static") + beam(slenderness, cells) + clamp_and_plane
                         + named_sections(
                             "Loads", { { "tip", set("Select", "boundary 2")
                                                     + set("Force", "0; 0; t*" + shortest_text(force)) } })
                         + increments((alpha + 2) / 3));
      return mean_displacement(scene.problem, scene.solve(), "boundary 2") / slenderness;
    }

    std::vector<Measurement>
    cantilever(const double       slenderness,
               const unsigned int alpha,
               const double       deflection,
               const double       shortening)
    {
      Refinement                        w, u;
      const std::array<unsigned int, 3> cells = { { 5, 10, 20 } };
      for (unsigned int mesh = 0; mesh < 3; ++mesh)
      {
        const auto tip = cantilever_tip(slenderness, alpha, cells[mesh]);
        w.values[mesh] = tip[2];
        u.values[mesh] = -tip[0];
      }
      return { { "w/L", deflection, w.smooth_limit(), Comparison::relative, 0.01 },
               { "u/L", shortening, u.smooth_limit(), Comparison::relative, 0.01 },
               { "order of w", 2., w.order(), Comparison::absolute, 0.3 },
               { "order of u", 2., u.order(), Comparison::absolute, 0.3 } };
    }
    /// A force that grows with t and rotates from x towards z, by `angle` at t = 1.
    std::string
    turning(const double force, const double angle)
    {
      const std::string size = shortest_text(force) + "*t*",
                        at   = "(" + shortest_text(angle) + "*t)";
      return size + "cos" + at + "; 0; " + size + "sin" + at;
    }

    /// End moment M t by dead forces on the nodes of the face x = L: the linear traction sigma(z) =
    /// -M z / I along the axis, which rotates with the arc of `angle` t.
    std::string
    couple(const Mesh &mesh, const double slenderness, const unsigned int cells, const double angle)
    {
      const double                                     moment = E * I * angle / slenderness;
      const double                                     dz     = 1. / cells;
      std::vector<std::pair<std::string, std::string>> loads;
      for (unsigned int node = 0; node < mesh.n_nodes(); ++node)
      {
        const dealii::Point<3> &X = mesh.get_nodes()[node];
        if (std::abs(X[0] - slenderness) > 1e-9)
          continue;
        // integral of z N over the two cells beside z (one at an edge), half the width
        const bool   edge = std::abs(std::abs(X[2]) - 0.5) < 1e-9;
        const double first
            = edge ? dz * (X[2] / 3. + (X[2] - std::copysign(dz, X[2])) / 6.) : dz * X[2];
        const double force = -moment / I * first * width / 2.;
        loads.emplace_back(fmt::format("n{}", node),
                           set("Select", "sphere " + shortest_text(X[0]) + " " + shortest_text(X[1])
                                             + " " + shortest_text(X[2]) + " 1e-6")
                               + set("Force", turning(force, angle)));
      }
      return named_sections("Loads", loads);
    }

    std::vector<Measurement>
    pure_bending()
    {
      const double                      L = 20., angle = M_PI / 2.;
      const std::array<unsigned int, 3> cells = { { 5, 10, 20 } };
      Refinement                        w, u;
      for (unsigned int mesh = 0; mesh < 3; ++mesh)
      {
        const unsigned int n    = cells[mesh];
        const std::string  text = set("Scene", "static") + beam(L, n) + clamp_and_plane;
        const Scene        unloaded(text);
        Scene      scene(text + couple(unloaded.problem.body.mesh, L, n, angle) + increments(4));
        const auto tip = mean_displacement(scene.problem, scene.solve(), "boundary 2") / L;
        w.values[mesh] = tip[2];
        u.values[mesh] = -tip[0];
      }
      return {
        { "w/L", (1. - std::cos(angle)) / angle, w.smooth_limit(), Comparison::relative, 0.01 },
        { "u/L", 1. - std::sin(angle) / angle, u.smooth_limit(), Comparison::relative, 0.01 },
        { "order of w", 2., w.order(), Comparison::absolute, 0.3 },
        { "order of u", 2., u.order(), Comparison::absolute, 0.3 }
      };
    }

    /// f_1 [Hz] for stiffness and mass at rest, by inverse iteration K y = M x, with the Rayleigh
    /// quotient y.K y / y.M y.
    double
    first_frequency(const double slenderness, const unsigned int cells)
    {
      Scene       scene(set("Scene", "static") + beam(slenderness, cells) + clamp_and_plane);
      Problem    &p    = scene.problem;
      const auto &free = p.constraints.free_dofs.list();
      const Mass  mass(p.body.fe_space, p.body.material, MassMatrix::consistent);
      dealii::Vector<double> mode(p.body.fe_space.n_dofs());
      for (const unsigned int dof : free)
        if (dof % 3 == 2)
          mode[dof] = std::pow(p.body.fe_space.rest_positions()[dof - 2], 2);
      p.cells().get_field().update_rotations(p.body.fe_space.rest_positions());
      p.system.factorize(p.body.fe_space.rest_positions(), {}, 0.);
      double omega_squared = 0.;
      for (unsigned int iteration = 0; iteration < 8; ++iteration) // f_2/f_1 = 6.3: error 36^-8
      {
        const auto     right_side = mass_times(mass, mode);
        BorderedVector unknowns;
        for (const unsigned int dof : free)
          unknowns.positions.push_back(right_side[dof]);
        p.system.bordered().solve(unknowns, {});
        for (unsigned int i = 0; i < free.size(); ++i)
          mode[free[i]] = unknowns.positions[i];
        const double y_M_y = mode * mass_times(mass, mode);
        omega_squared      = (mode * right_side) / y_M_y;
        mode /= std::sqrt(y_M_y);
      }
      return std::sqrt(omega_squared) / (2. * M_PI);
    }

    std::vector<Measurement>
    frequency()
    {
      const double L = 20., density = 1000.;
      Refinement   f;
      for (unsigned int mesh = 0; mesh < 3; ++mesh)
        f.values[mesh] = first_frequency(L, 4u << mesh);
      const double expected
          = std::pow(1.8751, 2) / (2. * M_PI * L * L) * std::sqrt(E * I / (density * width));
      return { { "f_1", expected, f.smooth_limit(), Comparison::relative, 0.01 },
               { "order", 2., f.order(), Comparison::absolute, 0.3 } };
    }
  } // namespace

  std::vector<Case>
  beam_cases()
  {
    std::vector<Case> cases;
    const auto        add_cantilever
        = [&](const unsigned int slenderness, const unsigned int alpha, double w, double u)
    {
      cases.push_back({ fmt::format("cantilever-{}-a{}", slenderness, alpha),
                        fmt::format("dead load P on the end, P L^2 = {} E I, L/h = {}; solid (not "
                                    "beam) by quadratic elements, fine",
                                    alpha, slenderness),
                        [=] { return cantilever(slenderness, alpha, w, u); } });
    };
    add_cantilever(10, 1, .30372, .05680);
    add_cantilever(10, 2, .49727, .16186);
    add_cantilever(10, 4, .67652, .33171);
    add_cantilever(10, 10, .82366, .56010);
    add_cantilever(20, 1, .30222, .05653);
    add_cantilever(20, 2, .49442, .16095);
    add_cantilever(20, 4, .67164, .32966);
    add_cantilever(20, 10, .81394, .55634);
    cases.push_back(
        { "pure-bending",
          "end moment, E I phi / L with phi = 90 degrees, L/h = 20: an arc of a circle; "
          "differs by O((kappa h)^2)",
          pure_bending });
    cases.push_back({ "frequency",
                      "clamped-free beam, L/h = 20: f_1 = 1.8751^2 / (2 pi L^2) sqrt(E I / rho A)",
                      frequency });
    return cases;
  }
} // namespace Exemplar::Verification
