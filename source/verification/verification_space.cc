// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/verification/verification.h>
#include <exemplar/verification/verification_scene.h>

#include <fmt/core.h>

#include <cmath>

// Discretisation errors up to nearly incompressible bodies, in plane strain: one layer of cells
// whose sides do not move across. Each case uses three meshes, each with cells of half the size,
// and their limit. Loads are small, so that linear elasticity applies.

namespace Exemplar::Verification
{
  namespace
  {
    /// Settings of Model, and their name in cases and in doc/.
    struct Element
    {
      std::string              name;
      std::vector<std::string> settings;
    };

    const Element linear{ "P1", { "Model/Dilatation=cells" } },
        patches{ "patches", { "Model/Dilatation=patches" } },
        quadratic{ "P2", { "Model/Element=P2", "Model/Dilatation=cells" } },
        mean{ "P2-patches", { "Model/Element=P2", "Model/Dilatation=patches" } };

    /// Number of cells across a body in its coarsest mesh: 8 for patches, so that there are two.
    unsigned int
    coarsest(const Element &element)
    {
      return element.name == patches.name ? 8 : 4;
    }

    using Cells = std::array<unsigned int, 3>;
    using Map   = std::function<dealii::Point<3>(const dealii::Point<3> &)>;

    constexpr int first_strip = 100;

    /// The unit box, mapped. The boundary `loaded` is divided into strips of a cell's width along
    /// `axis`, with ids from first_strip, so that the load may vary by strip.
    Inputs
    striped_box(const Cells &n_cells, const int loaded, const unsigned int axis, const Map &map)
    {
      const double origin = axis == 0 ? 0. : 0.5;
      Inputs       body   = moved_box({ { 1., 1., 1. } }, n_cells, [](const auto &p) { return p; });
      for (MshElement &face : body.mesh.elements)
        if (face.type == MshElementType::triangle && face.physical == loaded)
        {
          double centroid = origin;
          for (const std::size_t node : face.nodes)
            centroid += body.mesh.nodes[node][axis] / 3.;
          face.physical = first_strip + static_cast<int>(centroid * n_cells[axis]);
        }
      for (dealii::Point<3> &node : body.mesh.nodes)
        node = map(node);
      return body;
    }

    std::string
    vector_text(const dealii::Tensor<1, 3> &v)
    {
      return "t*" + shortest_text(v[0]) + "; t*" + shortest_text(v[1]) + "; t*"
             + shortest_text(v[2]);
    }

    /// Forces on the strips of a striped box.
    std::string
    strip_loads(const unsigned int                                       n,
                const std::function<dealii::Tensor<1, 3>(unsigned int)> &force)
    {
      std::vector<std::pair<std::string, std::string>> loads;
      for (unsigned int strip = 0; strip < n; ++strip)
        loads.emplace_back(fmt::format("strip {}", strip),
                           set("Select", fmt::format("boundary {}", first_strip + strip))
                               + set("Force", vector_text(force(strip))));
      return named_sections("Loads", loads);
    }

    /// A static scene of unit modulus in one increment.
    std::string
    small_static(const double poisson)
    {
      return set("Scene", "static")
             + section("Material", set("Young's modulus", 1.) + set("Poisson's ratio", poisson))
             + section("Time", set("Increments", "1"));
    }

    std::pair<std::string, std::string>
    held(const std::string &name, const unsigned int boundary, const std::string &more = "")
    {
      return { name, set("Select", fmt::format("boundary {}", boundary)) + more };
    }

    /// Cook's membrane (0,0), (48,44), (48,60), (0,44) in plane strain under a unit load: the mean
    /// displacement along the loaded edge of its nodes near `place`.
    double
    cook_deflection(const Element     &element,
                    const double       poisson,
                    const unsigned int cells,
                    const double       place)
    {
      const Inputs membrane = moved_box(
          { { 1., 1., 1. } }, { { cells, cells, 1 } },
          [](const dealii::Point<3> &p)
          {
            const double eta = p[1] + 0.5;
            return dealii::Point<3>(48. * p[0], 44. * p[0] + eta * (44. - 28. * p[0]), p[2]);
          });
      const double      force = 1e-4;
      const auto        plane = set("Components", "z");
      Scene             scene(small_static(poisson)
                                  + named_sections("Handles", { held("end", 1), held("back", 5, plane),
                                                                held("front", 6, plane) })
                                  + named_sections("Loads", { { "edge", set("Select", "boundary 2")
                                                                            + set("Force", "0; 1e-4*t; 0") } }),
                              element.settings, membrane);
      const std::string low = shortest_text(place - 0.1), high = shortest_text(place + 0.1);
      return mean_displacement(scene.problem, scene.solve(),
                               "box 47.9 " + low + " -1 48.1 " + high + " 1")[1]
             / force;
    }

    std::vector<Measurement>
    cook(const Element     &element,
         const double       poisson,
         const double       expected,
         const unsigned int coarsest)
    {
      Refinement deflection;
      for (unsigned int mesh = 0; mesh < 3; ++mesh)
        deflection.values[mesh] = cook_deflection(element, poisson, coarsest << mesh, 52.);
      return { { "mid-point of the loaded edge", expected, deflection.limit(), Comparison::relative,
                 0.01 },
               { "order", 1., deflection.order(), Comparison::at_least } };
    }

    /// Deflections on a 16 x 16 mesh relative to the limit, by P1 and by an element without
    /// locking.
    std::vector<Measurement>
    cook_locking(const double poisson, const double limit)
    {
      const auto part = [&](const Element &element)
      { return cook_deflection(element, poisson, 16, 52.) / limit; };
      return { { "P1, 16 x 16, of the limit: locks", 0.5, part(linear), Comparison::at_most },
               { "patches, 16 x 16, of the limit", 0.85, part(patches), Comparison::at_least },
               { "P2, 16 x 16, of the limit", 0.95, part(quadratic), Comparison::at_least } };
    }

    /// A thick cylinder, 1 <= r <= 2, in plane strain under a unit inner pressure: the mean radial
    /// displacement of the inner wall. The mesh is a quarter between symmetry planes; the wall is a
    /// polygon.
    double
    cylinder_expansion(const Element &element, const double poisson, const unsigned int cells)
    {
      const unsigned int n   = 2 * cells; // along the quarter
      const auto         arc = [&](const double part, const double r) {
        return dealii::Point<3>(r * std::cos(part * M_PI / 2.), r * std::sin(part * M_PI / 2.), 0.);
      };
      const Map bend = [&](const dealii::Point<3> &p)
      { return arc(p[1] + 0.5, 1. + p[0]) + dealii::Point<3>(0., 0., p[2] / cells); };
      const Inputs body     = striped_box({ { cells, n, 1 } }, 1, 1, bend);
      const double pressure = 1e-4, chord = 2. * std::sin(M_PI / (4. * n));
      const auto   force = [&](const unsigned int strip)
      { return arc((strip + 0.5) / n, pressure * chord / cells) - dealii::Point<3>(); };
      Scene        scene(small_static(poisson)
                             + named_sections("Handles", { held("y = 0", 3, set("Components", "y")),
                                                           held("x = 0", 4, set("Components", "x")),
                                                           held("back", 5, set("Components", "z")),
                                                           held("front", 6, set("Components", "z")) })
                             + strip_loads(n, force),
                         element.settings, body);
      const State  state = scene.solve();
      double       sum   = 0.;
      unsigned int count = 0;
      const auto  &nodes = scene.problem.body.mesh.get_nodes();
      for (unsigned int node = 0; node < nodes.size(); ++node)
        if (const double r = std::hypot(nodes[node][0], nodes[node][1]); r < 1. + 1e-9)
        {
          sum += std::hypot(state.positions[3 * node], state.positions[3 * node + 1]) - r;
          ++count;
        }
      return sum / count / pressure;
    }

    /// Lame's solution at r = a = 1, b = 2: u = (1 + nu) a^2 / (E (b^2 - a^2)) ((1 - 2 nu) r + b^2
    /// / r) p.
    double
    lame_expansion(const double poisson)
    {
      return (1. + poisson) / 3. * (1. - 2. * poisson + 4.);
    }

    std::vector<Measurement>
    cylinder(const Element &element, const double poisson, const double tolerance)
    {
      Refinement expansion;
      for (unsigned int mesh = 0; mesh < 3; ++mesh)
        expansion.values[mesh] = cylinder_expansion(element, poisson, coarsest(element) << mesh);
      return { { "inner wall, limit", lame_expansion(poisson), expansion.limit(),
                 Comparison::relative, tolerance },
               { "order", 1., expansion.order(), Comparison::at_least } };
    }

    /// Timoshenko's cantilever of length 4 and height 1 in plane strain: at x = 0 the displacements
    /// of the closed form, at the end a load P = 1 with a parabolic distribution over the height
    /// (S. Timoshenko, J. N. Goodier, Theory of Elasticity, section 21). Returns the mean
    /// displacement of the end along the load.
    double
    timoshenko_deflection(const Element &element, const double poisson, const unsigned int cells)
    {
      const double L = 4., P = 1e-5, thickness = 1. / cells;
      const double E = 1. / (1. - poisson * poisson), nu = poisson / (1. - poisson), I = 1. / 12.;
      const Inputs body  = striped_box({ { 4 * cells, 1, cells } }, 2, 2,
                                       [&](const dealii::Point<3> &p) {
                                        return dealii::Point<3>(L * p[0], thickness * p[1], p[2]);
                                      });
      const auto   force = [&](const unsigned int strip)
      {
        const auto up_to = [&](const double z) { return P / (2. * I) * (z / 4. - z * z * z / 3.); };
        const double low = -0.5 + strip / static_cast<double>(cells);
        return dealii::Tensor<1, 3>({ 0., 0., (up_to(low + 1. / cells) - up_to(low)) * thickness });
      };
      const std::string motion = "-t*z*(z*z-0.25)*" + shortest_text(P * (2. + nu) / (6. * E * I))
                                 + "; 0; t*z*z*" + shortest_text(P * nu * L / (2. * E * I));
      Scene scene(small_static(poisson)
                      + named_sections("Handles", { held("end", 1, set("Motion", motion)),
                                                    held("back", 3, set("Components", "y")),
                                                    held("front", 4, set("Components", "y")) })
                      + strip_loads(cells, force),
                  element.settings, body);
      return mean_displacement(scene.problem, scene.solve(), "box 3.999 -1 -1 4.001 1 1")[2] / P;
    }

    std::vector<Measurement>
    timoshenko(const Element &element, const double poisson, const double tolerance)
    {
      const double L = 4., E = 1. / (1. - poisson * poisson), nu = poisson / (1. - poisson);
      Refinement   deflection;
      for (unsigned int mesh = 0; mesh < 3; ++mesh)
        deflection.values[mesh]
            = timoshenko_deflection(element, poisson, coarsest(element) << mesh);
      return { { "end, limit", 2. / E * ((4. + 5. * nu) * L / 4. + 2. * L * L * L),
                 deflection.limit(), Comparison::relative, tolerance },
               { "order", 1., deflection.order(), Comparison::at_least } };
    }
  } // namespace

  std::vector<Case>
  space_cases()
  {
    std::vector<Case> cases;
    const auto add = [&](const std::string &name, const std::string &description, auto measure) {
      cases.push_back({ name, description, measure });
    };
    const std::string membrane = "Cook's membrane, plane strain, small load, ";
    add("cook-0.333", membrane + "nu = 1/3", [] { return cook(linear, 1. / 3., 21.524, 16); });
    add("cook-0.3", membrane + "nu = 0.3", [] { return cook(linear, 0.3, 21.945, 16); });
    const double limit = 18.512;
    for (const Element &element : { patches, quadratic, mean })
      add("cook-0.4999-" + element.name,
          membrane + "nu = 0.4999: doc/scripts/measure_space_limits.py",
          [=] { return cook(element, 0.4999, limit, 8); });
    add("cook-0.4999-locking", "what P1 has of that limit, and what the others have",
        [=] { return cook_locking(0.4999, limit); });
    const auto add_closed_form
        = [&](const std::string &name, const std::string &description, const auto &measure)
    {
      add(name + "-0.3-P1", description + ", nu = 0.3", [=] { return measure(linear, 0.3, 0.01); });
      for (const Element &element : { patches, quadratic, mean })
        add(name + "-0.4999-" + element.name, description + ", nu = 0.4999",
            [=] { return measure(element, 0.4999, 0.01); });
    };
    add_closed_form("cylinder", "thick cylinder under pressure, plane strain (Lame)", cylinder);
    add_closed_form("timoshenko", "cantilever under a parabolic end load, plane strain",
                    timoshenko);
    return cases;
  }
} // namespace Exemplar::Verification
