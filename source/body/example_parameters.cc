// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/example_parameters.h>
#include <exemplar/mesh/map_name.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/prm/key_table.h>

#include <cmath>
#include <optional>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    const EnumTable<ExampleEnergy>     energies        = { { ExampleEnergy::scaled, "scaled" },
                                                           { ExampleEnergy::blended, "blended" },
                                                           { ExampleEnergy::mixed, "mixed" } };
    const EnumTable<ActsOn>            kinds_of_acting = { { ActsOn::all, "all" },
                                                           { ActsOn::shape, "shape" },
                                                           { ActsOn::volume, "volume" },
                                                           { ActsOn::along_fibres, "along fibres" },
                                                           { ActsOn::across_fibres, "across fibres" } };
    const EnumTable<RegionsOfExamples> kinds_of_regions
        = { { RegionsOfExamples::none, "none" }, { RegionsOfExamples::automatic, "auto" } };
    const EnumTable<WeightRule> weight_kinds = { { WeightRule::simplex, "simplex" },
                                                 { WeightRule::free, "free" },
                                                 { WeightRule::prescribed, "prescribed" },
                                                 { WeightRule::additive, "additive" } };

    /// sigma for "auto", "weak" and "paper", in units of sum E V.
    double
    default_penalty(const ExampleParameters &parameters)
    {
      if (parameters.weight_penalty == "weak")
        return 1e-12;
      const bool is_small = parameters.weight_penalty == "auto" && parameters.are_bounded();
      return is_small ? 1e-9 : 1e-5;
    }

    /// The number in `text`, if it is one and not negative.
    std::optional<double>
    non_negative_number(const std::string &text)
    {
      std::istringstream in(text);
      double             value = -1.;
      if (in >> value && (in >> std::ws).eof() && value >= 0. && std::isfinite(value))
        return value;
      return {};
    }
  } // namespace

  void
  ExampleParameters::declare(KeyTable &keys)
  {
    keys.enter_subsection("Examples");
    keys.add_files("Poses", poses,
                   "Example poses: .msh files with the nodes and tetrahedra of the mesh, such "
                   "as the final.msh of another scene, or surfaces (.obj, .ply, .stl) with the "
                   "vertices and faces of Mesh/Surface (or of Mesh/File, if that is a surface), "
                   "which are carried onto the mesh as by exemplar pose.");
    keys.add("Attach", attach,
             "How strongly poses that are surfaces hold the mesh, over the stiffness of the body: "
             "more follows them more closely, less strains the cells less. For Handles/NAME/Follow "
             "pose and Initial/Pose, too.",
             Bounds{ 1e-3, 1e6 });
    keys.add("Pose functions", pose_functions,
             "Analytic example poses after those of Poses: x'; y'; z' as functions of the "
             "rest position x, y, z [m]; poses separated by |.",
             " | ");
    keys.add("Include rest pose", include_rest_pose,
             "Whether the rest pose is example 0. Without it a single example is a "
             "permanent pre-strain. Means nothing with additive weights.");
    keys.add("Bending importance", bending_importance,
             "Of a shell: factor of Importance for curvatures or angles; 1: bends and stretches "
             "follow alike; their product "
             "is at most 1.",
             Bounds{ 0. });
    keys.add("Importance", importance,
             "eta, how strongly the examples pull [-]: 0 is plain elasticity (no pose file is "
             "opened), 1 lets the examples "
             "alone be free of stress.",
             Bounds{ 0., 1. });
    keys.add(
        "Weight penalty", weight_penalty,
        "sigma [J] of the ridge sigma/2 sum w_i^2 on weights that are not prescribed: paper "
        "(1e-5 sum E V over the cells), auto (1e-9 sum E V with simplex or additive weights, which "
        "decides ties and moves hardly anything, and weak with Loads/Balanced; the paper's with "
        "free ones, which would run away), weak (1e-12 sum E V) or a number not less than 0.");
    keys.add(
        "Energy", energy, energies,
        "scaled: V/2 (strain - eta E(w)) : C : (strain - eta E(w)), as the paper; blended: (1 - "
        "eta) of the elastic energy and eta of the distance to E(w); mixed: four fifths of scaled "
        "and one of blended, with which every part of the range of Importance acts.");
    keys.add(
        "Acts on", acts_on, kinds_of_acting,
        "Which strains examples draw to theirs, the others being those of a body without examples: "
        "all; "
        "shape: all but the change of volume; volume: that alone; along fibres: the stretch along "
        "Material/Fibre direction, with what a tension along it does across; across fibres: all "
        "but that.");
    keys.add(
        "Example modulus", modulus,
        "Young's modulus [Pa] of the wish to be like the examples, where it is not the "
        "material's: with Energy = blended the energy density is (1 - eta)/2 strain : C : strain "
        "+ eta/2 (strain - E(w)) : C_e : (strain - E(w)) with this isotropic C_e, whatever the "
        "material is. Empty: the material's.");
    keys.add("Example Poisson ratio", poisson_ratio,
             "Poisson's ratio of C_e, see Example modulus, greater than -1 and less than 0.5. "
             "Empty: the material's.");
    keys.add(
        "Weights", weights, weight_kinds,
        "simplex, for poses: minimise the energy over weights that sum to one and are not "
        "negative; "
        "additive, for keys (a smile, a blink): over weights that are each between 0 and 1, of "
        "keys that are added to the rest pose (statistics: weight_i from weight_1 on); free: that "
        "sum to one, as the paper; prescribed: as Prescribed weights gives them.");
    keys.add("Prescribed weights", prescribed_weights,
             "One function of t for each example, the rest pose first where it is "
             "included, separated by ;. They sum to one. Empty in an interpolation between two "
             "examples: 1-t; t. With Weights per region either "
             "the same for all, or one such list a region, in ascending order of material "
             "ids, separated by |.",
             "; ");
    keys.add_file(
        "Weights file", weights_file,
        "A table of prescribed weights in CSV, instead of Prescribed weights: lines of t [s] and "
        "one "
        "weight per example, in their order, with or without a first line of names. Without a "
        "column "
        "of the rest pose, its weight is 1 minus the others. Linear between lines, constant "
        "before the first and after the last; the same in all regions.");
    keys.add(
        "Yield", yield,
        "How much energy [J/m^3] it costs to change simplex or additive weights: a step adds Y_i "
        "times the "
        "change of each weight, with Y_i = Yield times the volume on which it acts, so that a "
        "weight stays where it is until the force on it is greater than Y_i, and a body that is "
        "let go stays bent. 0: examples let go at once. For a start take a hundredth of E times "
        "the square of the examples' strains.",
        Bounds{ 0. });
    keys.add("Creep viscosity", creep_viscosity,
             "How much simplex or additive weights resist the rate of their change in a dynamic "
             "scene [J s/m^3]: "
             "a force of c_i times the rate, with c_i = Creep viscosity times the volume on which "
             "the weight acts. 0: they follow at once.",
             Bounds{ 0. });
    keys.add("Weights per region", weights_per_region,
             "Whether the cells of each material id have weights of their own "
             "(statistics: weight_R_i for example i in region R).");
    keys.add(
        "Regions", regions, kinds_of_regions,
        "auto: parts of the body that the examples strain alike and apart from others, as limbs, "
        "a tail and a head, are found and have weights of their own (statistics: weight_R_i for "
        "example i in region R, from 1, as the log and summary.json describe them); none: what "
        "Weights per region or Weight maps say.");
    keys.add("Region blend length", region_blend_length,
             "Distance [m] over which the weights of neighbouring regions pass into each "
             "other; 0: at once, at the border, and with Regions = auto over a quarter of the cube "
             "root of "
             "the smallest one's volume. Below the size of a cell: over about a cell.",
             Bounds{ 0. });
    keys.add_files("Weight maps", weight_maps,
                   "Painted regions with weights of their own: a list of FILE.ply:ATTRIBUTE or "
                   "FILE.csv[:COLUMN], each with values from 0 to 1 for the vertices of "
                   "Mesh/Surface. The weights of map R, from 1 (statistics: weight_R_i), act in a "
                   "cell by the share of its value; values that sum to more than 1 are divided by "
                   "their sum, and what they lack to 1 is of a region 0.");
    keys.leave_subsection();
  }

  bool
  ExampleParameters::in_use() const
  {
    return importance > 0. && !(poses.empty() && pose_functions.empty());
  }

  std::size_t
  ExampleParameters::n_examples() const
  {
    return (has_rest_pose() ? 1 : 0) + poses.size() + split_trimmed(pose_functions, '|').size();
  }

  double
  ExampleParameters::ridge(const double unit_energy) const
  {
    return non_negative_number(weight_penalty).value_or(default_penalty(*this) * unit_energy);
  }

  void
  ExampleParameters::check_memory() const
  {
    if (!in_use() || are_bounded() || (yield == 0. && creep_viscosity == 0.))
      return;
    const std::string key = yield > 0. ? "Yield" : "Creep viscosity";
    throw UserError("Examples/" + key
                    + " makes weights that are found remember where they were, but "
                    + (weights == WeightRule::free
                           ? "Examples/Weights = free has no bounds that would hold them. Set "
                             "Examples/Weights = simplex or additive"
                           : std::string("the weights of this scene are prescribed. Set "
                                         "Examples/Weights = simplex or additive in a static or "
                                         "dynamic scene"))
                    + ", or remove Examples/" + key + ".");
  }

  namespace
  {
    /// The value of a constant strictly between bounds; none if `text` is empty.
    std::optional<double>
    constant_in(const std::string &key,
                const std::string &text,
                const double       lower,
                const double       upper,
                const std::string &allowed)
    {
      if (text.empty())
        return {};
      const double value = parse_number(text);
      if (!(value > lower && value < upper))
        throw UserError("Examples/" + key + " = '" + text + "' is not allowed. Allowed: " + allowed
                        + ", or nothing, which takes the material's.");
      return value;
    }
  } // namespace

  ExampleElasticity
  ExampleParameters::elasticity() const
  {
    const ExampleElasticity own{ constant_in("Example modulus", modulus, 1e-300, 1e300,
                                             "a number greater than 0 [Pa]"),
                                 constant_in("Example Poisson ratio", poisson_ratio, -1., 0.5,
                                             "a number greater than -1 and less than 0.5") };
    return in_use() ? own : ExampleElasticity();
  }

  void
  ExampleParameters::check_elasticity() const
  {
    if (!elasticity().is_own() || energy == ExampleEnergy::blended)
      return;
    const std::string key = modulus.empty() ? "Example Poisson ratio" : "Example modulus";
    throw UserError("Examples/" + key
                    + " gives the wish to be like the examples an elasticity of its own, beside "
                      "that of the body, which only Examples/Energy = blended tells apart. Set "
                      "that, or remove Examples/"
                    + key + ".");
  }

  void
  ExampleParameters::check() const
  {
    check_memory();
    check_elasticity();
    if (weight_penalty != "auto" && weight_penalty != "paper" && weight_penalty != "weak"
        && !non_negative_number(weight_penalty))
      throw UserError(
          "Examples/Weight penalty = '" + weight_penalty
          + "' is not allowed. Allowed: auto, paper, weak or a number not less than 0 [J].");
    if (!weights_file.empty() && !prescribed_weights.empty())
      throw UserError("Examples/Prescribed weights and Examples/Weights file are both given. "
                      "Remove one of them.");
    if (weights == WeightRule::prescribed && in_use() && prescribed_weights.empty()
        && weights_file.empty())
      throw UserError(
          n_examples() == 1
              ? "Examples/Prescribed weights is empty, and there is one example: its weight would "
                "always "
                "be 1. Give another example, or set Examples/Include rest pose = true, and "
                "Examples/Prescribed weights = 1-t; t."
              : "Examples/Weights = prescribed, but Examples/Prescribed weights is empty. Give one "
                "function "
                "of t for each example, for instance '1-t; t', or set Examples/Weights file.");
    for (const std::string &map : weight_maps)
      split_map_name(map, "Examples/Weight maps");
    if (!weight_maps.empty() && weights_per_region)
      throw UserError(
          "Examples/Weight maps and Examples/Weights per region are both given, but only "
          "one of them can say where weights act. Remove one of them.");
    if (regions == RegionsOfExamples::automatic && (weights_per_region || !weight_maps.empty()))
      throw UserError(std::string("Examples/Regions = auto finds where weights act, but Examples/")
                      + (weights_per_region ? "Weights per region = true" : "Weight maps")
                      + " says it, too. Remove one of them.");
    if (region_blend_length > 0. && !weights_per_region && regions == RegionsOfExamples::none)
      throw UserError("Examples/Region blend length is given, but Examples/Weights per region is "
                      "false and Examples/Regions is none. Set one of them, or remove the length.");
    const std::string given = prescribed_weights.empty() ? "Weights file" : "Prescribed weights";
    if (weights != WeightRule::prescribed && !(prescribed_weights.empty() && weights_file.empty()))
      throw UserError("Examples/" + given
                      + " is given, but Examples/Weights is not "
                        "'prescribed'. Set it, or remove the weights.");
  }
} // namespace Exemplar
