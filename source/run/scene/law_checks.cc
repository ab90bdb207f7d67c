// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/kernels/cell_model.h>
#include <exemplar/run/scene/scene_parameters.h>

#include <fmt/core.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    /// Whether the constants of a section give cells a law by ModelTraits::chosen_by.
    bool
    is_chosen(const CellLaw law, const ElasticConstants &constants)
    {
      const auto keys = traits_of(law).chosen_by;
      return keys[0] != nullptr
             && std::all_of(keys.begin(), keys.end(),
                            [&](const char *const key)
                            { return key == nullptr || constants.own.at(key) > 0.; });
    }

    /// Whether constants give cells a law that remembers and is not chosen by `other`.
    bool
    have_memory(const ElasticConstants &constants, const char *const other = nullptr)
    {
      const std::vector<CellLaw> laws = all_laws();
      return std::any_of(laws.begin(), laws.end(),
                         [&](const CellLaw law)
                         {
                           return traits_of(law).n_history > 0 && is_chosen(law, constants)
                                  && traits_of(law).chosen_by[0] != other;
                         });
    }

    /// Whether some section gives cells a law that remembers.
    bool
    has_memory(const MaterialParameters &material)
    {
      bool has = false;
      material.for_each_section(
          [&](const ElasticConstants &constants, const std::string & /*section*/)
          { has |= have_memory(constants); });
      return has;
    }

    bool
    is_there(const Beside            beside,
             const SceneParameters  &scene,
             const ElasticConstants &constants,
             const CellLaw           law)
    {
      switch (beside)
      {
      case Beside::interpolation:
        return scene.scene == SceneKind::interpolation;
      case Beside::statics:
        return scene.scene == SceneKind::statics;
      case Beside::other_strain:
        return scene.model.law() != CellLaw::corotational && scene.model.law() != law
               && !scene.material.law_of_grain();
      case Beside::grain:
        return scene.material.law_of_grain().has_value();
      case Beside::fibres:
        return constants.has_grain() && constants.orthotropy.empty();
      case Beside::orthotropy:
        return !constants.orthotropy.empty();
      case Beside::memory:
        return has_memory(scene.material);
      case Beside::other_memory:
        return have_memory(constants, traits_of(law).chosen_by[0]);
      case Beside::unblended_examples:
        return scene.examples.in_use() && scene.examples.energy != ExampleEnergy::blended;
      case Beside::own_elasticity:
        return scene.examples.elasticity().is_own();
      case Beside::varying_importance:
        return scene.examples.in_use() && scene.material.importance_varies();
      }
      return false;
    }

    /// Where a law is chosen by these constants of a section, or by Model, refuse what it has no place beside.
    void
    check_law(const CellLaw           law,
              const SceneParameters  &scene,
              const ElasticConstants &constants,
              const std::string      &section)
    {
      const char *const chosen_by = traits_of(law).chosen_by[0];
      // grain stands in Model's place
      const bool is_of_model
          = law == CellLaw::neo_hookean ? scene.model.is_neo_hookean() : law == scene.model.law();
      if (chosen_by != nullptr ? !is_chosen(law, constants) : !is_of_model)
        return;
      for (const Refusal &refusal : refusals_of(law))
      {
        if (refusal.constant != nullptr && !(constants.own.at(refusal.constant) > 0.))
          continue;
        const char *const constant = refusal.constant != nullptr ? refusal.constant : chosen_by;
        const std::string key      = constant != nullptr
                                         ? section + "/" + constant
                                         : "Model/Background = " + std::string(traits_of(law).name);
        const std::string without
            = constant != nullptr ? key + " = 0" : "Model/Background = corotational";
        if (is_there(refusal.beside, scene, constants, law))
          throw UserError(key + fmt::format(fmt::runtime(refusal.words), without));
      }
    }
  } // namespace

  void
  CompleteScene::check_laws() const
  {
    const auto check = [this](const CellLaw law)
    {
      material.for_each_section([&](const ElasticConstants &constants, const std::string &section)
                                { check_law(law, *this, constants, section); });
    };
    for (const bool is_chosen_by_model : { true, false }) // what Model asks for comes first
      for (const CellLaw law : all_laws())
        if ((traits_of(law).chosen_by[0] == nullptr) == is_chosen_by_model)
          check(law);
  }
} // namespace Exemplar
