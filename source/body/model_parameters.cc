// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/body/model_parameters.h>
#include <exemplar/prm/key_table.h>

namespace Exemplar
{
  namespace
  {
    /// The laws that Model/Strain chooses from.
    EnumTable<CellLaw>
    make_strains()
    {
      EnumTable<CellLaw> strains;
      for (const CellLaw law : all_laws())
        if (traits_of(law).is_strain())
          strains.emplace_back(law, traits_of(law).name);
      return strains;
    }

    EnumTable<Element>
    make_elements()
    {
      EnumTable<Element> elements;
      for (std::size_t i = 0; i < std::size(element_traits); ++i)
        elements.emplace_back(static_cast<Element>(i), element_traits[i].name);
      return elements;
    }

    const EnumTable<CellLaw> strains = make_strains();

    std::string
    describe_strains()
    {
      std::string text;
      for (const auto &[law, name] : strains)
        text += (text.empty() ? "" : "; ") + name + ": " + traits_of(law).strain;
      return text + ". Example strains are of the same measure.";
    }

    /// Names of the strains whose volume part patches may have.
    std::string
    strains_with_patches()
    {
      std::vector<std::string> names;
      for (const auto &[law, name] : strains)
        if (traits_of(law).trace_gradient_is_R)
          names.push_back(name);
      std::string text;
      for (std::size_t i = 0; i < names.size(); ++i)
        text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
      return text;
    }

    const EnumTable<GradientKind> gradient_kinds
        = { { GradientKind::consistent, "consistent" }, { GradientKind::frozen, "frozen" } };
    const EnumTable<DilatationKind> dilatation_kinds = { { DilatationKind::automatic, "auto" },
                                                         { DilatationKind::cells, "cells" },
                                                         { DilatationKind::patches, "patches" } };
    const EnumTable<Element>        elements         = make_elements();
    const EnumTable<Background>     backgrounds
        = { { Background::corotational, "corotational" },
            { Background::neo_hookean, traits_of(CellLaw::neo_hookean).name } };
    const EnumTable<ShellKind> shells
        = { { ShellKind::plate, "plate" }, { ShellKind::hinges, "hinges" } };
  } // namespace

  void
  ModelParameters::declare(KeyTable &keys)
  {
    keys.enter_subsection("Model");
    keys.add("Strain", strain, strains, describe_strains());
    keys.add(
        "Gradient", gradient, gradient_kinds,
        "consistent: the force is the gradient of the energy; frozen: the paper's force R T, "
        "which holds the rotation fixed while it differentiates the energy. Strains other than the "
        "corotational one always use their gradient.");
    keys.add(
        "Dilatation", dilatation, dilatation_kinds,
        "cells: each cell resists the change of its own volume; patches: patches of cells that "
        "share a node resist the mean of theirs, so that linear tetrahedra bend and squeeze as "
        "they should also near Poisson's ratio 0.5, at 1.6 times the operations of a "
        "factorisation and 1.4 to 1.6 times the time of a step (doc/choosing.md), for the "
            + strains_with_patches()
            + " strains; with a neo-Hookean background they resist the mean of J = det F; auto: "
              "patches with these in statics and dynamics, cells with other strains and in "
              "interpolations.");
    keys.add(
        "Element", element, elements,
        "P1: linear tetrahedra, the cells of the mesh with their nodes; P2: quadratic "
        "tetrahedra with straight edges at rest and a further node in the middle of each edge, "
        "which may bend and are far more accurate on the same mesh, where Poisson's ratio is "
        "near 1/2 above all. Strains, rotations and example strains are at four points of each "
        "cell then.");
    keys.add(
        "Background", background, backgrounds,
        "The energy that the body has of its own, beside its examples: corotational: that of the "
        "strain; neo-hookean: the stable neo-Hookean one of Smith, de Goes and Kim (2018), with "
        "the "
        "same resistance to small strains, for large stretches (doc/model.md). It is for the "
        "corotational strain with consistent forces and, where there are examples, "
        "Examples/Energy = blended; examples act on the corotational strain.");
    keys.add("Shell", shell, shells,
             "What a shell (Mesh/Kind) resists and its examples ask for: plate: three membrane "
             "strains and three "
             "curvatures of each triangle, with the slope of the normal at each edge as an "
             "unknown; it converges. hinges: "
             "the lengths of edges and the angles between triangles, which depend on the mesh "
             "(doc/shells.md).");
    keys.leave_subsection();
  }

  void
  ModelParameters::complete()
  {
    if (dilatation == DilatationKind::automatic)
      dilatation
          = traits_of(law()).trace_gradient_is_R ? DilatationKind::patches : DilatationKind::cells;
  }

  void
  ModelParameters::check() const
  {
    if (has_patches() && !traits_of(law()).trace_gradient_is_R)
      throw UserError("Model/Dilatation = patches: is for the " + strains_with_patches()
                      + " strains, not for Model/Strain = " + traits_of(law()).name
                      + ". Leave it at auto, or take another strain.");
  }
} // namespace Exemplar
