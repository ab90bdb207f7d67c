// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/words.h>
#include <exemplar/python/arrays_to_python.h>
#include <exemplar/python/module_parts.h>

#include <fmt/core.h>

#include <limits>
#include <utility>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    /// The array made read-only, as writing to it would change nothing.
    py::array
    read_only(py::array array)
    {
      array.attr("flags").attr("writeable") = false;
      return array;
    }

    /// An array of number(cell) for all cells.
    template <typename Function>
    py::array
    by_cell(const HeldProblem &held, const Function &number)
    {
      const unsigned int  m = held.get().body.mesh.n_cells();
      std::vector<double> numbers;
      for (unsigned int cell = 0; cell < m; ++cell)
        numbers.push_back(number(cell));
      return read_only(array_of(std::move(numbers), { py::ssize_t(m) }));
    }

    /// A property of the material, which set_material() sets.
    template <typename Function>
    void
    add_constant(ProblemClass      &problem,
                 const char        *name,
                 const std::string &doc,
                 const Function    &constant)
    {
      const std::string refusal = fmt::format(
          "{0} is set by set_material: problem.set_material({0}=...), a number or an array (m,).",
          name);
      problem.def_property(
          name,
          [constant](const HeldProblem &held)
          {
            const Material &material = held.get().body.material;
            return by_cell(held, [&](const unsigned int cell) { return constant(material, cell); });
          },
          [refusal](HeldProblem &, const py::object &) { throw py::attribute_error(refusal); },
          doc.c_str());
    }

    void
    add_constants(ProblemClass &problem)
    {
      const std::string copy = " A copy, read only; set_material() sets it.";
      add_constant(problem, "young",
                   "Young's modulus (m,) [Pa] of each cell; nan where nine constants stand for it."
                       + copy,
                   [](const Material &material, const unsigned int cell)
                   {
                     const CellConstants &body = material.of_body_alone(cell);
                     return body.whole.orthotropic ? std::numeric_limits<double>::quiet_NaN()
                                                   : body.youngs_modulus;
                   });
      add_constant(problem, "poisson",
                   "Poisson's ratio (m,) [-] of each cell; nan where nine constants stand for it."
                       + copy,
                   [](const Material &material, const unsigned int cell)
                   {
                     const CellConstants &body = material.of_body_alone(cell);
                     return body.whole.orthotropic ? std::numeric_limits<double>::quiet_NaN()
                                                   : body.poissons_ratio;
                   });
      add_constant(problem, "density", "Density (m,) [kg/m^3] of each cell." + copy,
                   [](const Material &material, const unsigned int cell)
                   { return material.density(cell); });
    }

    py::array
    volumes(const HeldProblem &held)
    {
      const Mesh &mesh = held.get().body.mesh;
      if (mesh.is_shell())
        return by_cell(held, [&held](const unsigned int cell)
                       { return held.get().body.fe_space.cell_volume(cell); });
      return by_cell(held,
                     [&mesh](const unsigned int cell)
                     {
                       const auto &nodes = mesh.get_cells()[cell];
                       const auto  edge  = [&](const unsigned int v)
                       { return mesh.get_nodes()[nodes[v]] - mesh.get_nodes()[nodes[0]]; };
                       return dealii::cross_product_3d(edge(1), edge(2)) * edge(3) / 6.;
                     });
    }

    /// The nodes that each handle holds now.
    py::dict
    handles(const HeldProblem &held)
    {
      const Handles                      &all     = held.get().constraints.handles;
      const std::vector<Handles::Holding> holding = all.holding();
      py::dict                            found;
      for (unsigned int h = 0; h < all.size(); ++h)
      {
        std::vector<unsigned int> nodes
            = holding[h].holds ? holding[h].nodes : std::vector<unsigned int>();
        const auto n                = static_cast<py::ssize_t>(nodes.size());
        found[py::str(all.name(h))] = read_only(array_of(std::move(nodes), { n }));
      }
      return found;
    }

    std::vector<std::string>
    example_names(const HeldProblem &held)
    {
      const ExamplePoses      &poses = held.get().examples.poses;
      std::vector<std::string> names;
      for (unsigned int i = 0; i < poses.size(); ++i)
        names.push_back(poses.name(i));
      return names;
    }

    /// The regions of Examples/Regions = auto, with the words of summary.json.
    py::list
    weight_regions(const HeldProblem &held)
    {
      py::list found;
      for (const WeightRegion &region : held.get().body.weight_regions)
      {
        const auto &centre = region.centre;
        found.append(
            py::dict(py::arg("region") = py::len(found) + 1, py::arg("cells") = region.n_cells,
                     py::arg("volume")  = region.volume,
                     py::arg("centre")  = std::vector<double>{ centre[0], centre[1], centre[2] },
                     py::arg("example") = region.example));
      }
      return found;
    }

    const char *
    name_of(const SceneKind kind)
    {
      return kind == SceneKind::dynamic   ? "dynamic"
             : kind == SceneKind::statics ? "static"
                                          : "interpolation";
    }

    /// repr(problem); while another thread makes a step, it says no more than that.
    std::string
    representation(const HeldProblem &held)
    {
      if (held.is_of_another_thread())
        return "<exemplar.Problem: another thread makes a step>";
      const Problem     &problem = held.get();
      const unsigned int step = problem.state.step, n_steps = problem.time_axis.n_steps();
      return fmt::format("<exemplar.Problem: {} ({}), {}, {}, step {}{}, time {:.6g}>",
                         problem.parameters.name, name_of(problem.parameters.scene),
                         counted(problem.body.mesh.n_nodes(), "node"),
                         counted(problem.body.mesh.n_cells(), "cell"), step,
                         step > n_steps ? fmt::format(", {} beyond the scene's end", step - n_steps)
                                        : fmt::format(" of {}", n_steps),
                         problem.state.time);
    }
  } // namespace

  void
  add_body(ProblemClass &problem)
  {
    add_constants(problem);
    problem.def_property_readonly("volumes", &volumes,
                                  "Volumes (m,) [m^3] of the cells at rest. A copy, read only.");
    problem.def_property_readonly(
        "surface_triangles",
        [](const py::object &self)
        {
          const auto surface = py::module_::import("exemplar._plot").attr("surface");
          return py::object(surface(self.attr("cells"))[py::int_(0)]);
        },
        "Nodes (k, 3) of the triangles of the surface, from 0, counterclockwise seen from "
        "outside;\n"
        "uint32, a copy.");
    problem.def_property_readonly(
        "handles", &handles,
        "The nodes (k,) that each handle holds, a dictionary of uint32 arrays by name; empty for\n"
        "one that was let go. With Element = P2 also those in the middles of edges, as state\n"
        "counts them. A copy.");
    problem.def_property_readonly(
        "example_names", &example_names,
        "What the examples are called, in the order of the weights: a list of strings, files,\n"
        "formulas or 'rest pose'. Empty without examples.");
    problem.def_property_readonly(
        "weight_regions", &weight_regions,
        "The regions that Examples/Regions = auto found, in the order of the weights: a list of\n"
        "dictionaries as in summary.json, of region (from 1), cells, volume (fraction), centre "
        "(3)\n"
        "[m] and example. Empty without.");
    problem.def("__repr__", &representation);
  }
} // namespace Exemplar::Python
