// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/run/scene/scene_file.h>

#include "expect_contains.h"

#include <gtest/gtest.h>

#include <set>

namespace Exemplar::Testing
{
  namespace
  {
    SceneFile
    scene_file(const std::string &text, const std::vector<std::string> &overrides = {})
    {
      return SceneFile("/scenes/a.prm", text, overrides);
    }

    std::string
    text_of(const SceneFile &scene, const std::string &path)
    {
      for (const DeclaredKey &key : scene.get_keys())
        if (key.path() == path)
          return key.value;
      return "absent";
    }

    std::string
    refusal_of(const std::string &text)
    {
      try
      {
        scene_file(text);
      }
      catch (const UserError &error)
      {
        return error.what();
      }
      return "no UserError";
    }

    const std::string two_poses = "subsection Examples\nset Pose functions = x;y;2*z\n"
                                  "set Prescribed weights = 1-t; t\n";

    TEST(SceneParameters, DefaultIsASceneWithoutHandles)
    {
      SceneParameters scene;
      EXPECT_TRUE(scene.handles.empty());
      EXPECT_FALSE(scene.loads.has_gravity());
      EXPECT_EQ(CompleteScene(scene).solver.method, Method::quasi_newton);
    }

    TEST(SceneParameters, AutoIsTheMethodOfTheKindOfScene)
    {
      const auto method = [](const SceneKind kind, const GradientKind gradient)
      {
        SceneParameters scene;
        scene.scene          = kind;
        scene.model.gradient = gradient;
        return CompleteScene(scene).solver.method;
      };
      EXPECT_EQ(method(SceneKind::statics, GradientKind::consistent), Method::newton);
      EXPECT_EQ(method(SceneKind::dynamic, GradientKind::frozen), Method::fixed_point);
    }

    TEST(SceneParameters, AutoIsTheDilatationThatSuitsTheStrain)
    {
      const auto has_patches = [](const CellLaw strain, const DilatationKind dilatation)
      {
        SceneParameters scene;
        scene.model.strain     = strain;
        scene.model.dilatation = dilatation;
        return CompleteScene(scene).model.has_patches();
      };
      EXPECT_EQ(SceneParameters().model.dilatation, DilatationKind::automatic);
      EXPECT_TRUE(has_patches(CellLaw::corotational, DilatationKind::automatic));
      EXPECT_TRUE(has_patches(CellLaw::linear, DilatationKind::automatic));
      EXPECT_FALSE(has_patches(CellLaw::green, DilatationKind::automatic));
      EXPECT_FALSE(has_patches(CellLaw::linear, DilatationKind::cells));
      SceneParameters interpolation;
      interpolation.scene                   = SceneKind::interpolation;
      interpolation.examples.pose_functions = "x; y; 2*z";
      EXPECT_FALSE(CompleteScene(interpolation).model.has_patches());
    }

    TEST(SceneFile, FillsParametersThatOutliveIt)
    {
      const SceneParameters scene
          = scene_file("set Scene = static\nsubsection Handles\nset Names = a\nsubsection a\n"
                       "set Select = nodes list\nend\nend\n",
                       { "Loads/Gravity=0, 0, -9.81", "Mesh/File=b.msh" })
                .get_parameters();
      EXPECT_EQ(scene.name, "/scenes/a.prm");
      EXPECT_EQ(scene.scene, SceneKind::statics);
      EXPECT_EQ(scene.mesh.file, "/scenes/b.msh");
      EXPECT_EQ(scene.handles.at(0).name, "a");
      EXPECT_EQ(scene.handles.at(0).select.text, "nodes /scenes/list");
      EXPECT_EQ(scene.loads.gravity[2], -9.81);
      EXPECT_EQ(scene.output.directory, "output/a");
    }

    TEST(SceneFile, KeepsAutoAsTextButNotAsValue)
    {
      const SceneFile scene("", "set Scene = static\n", std::vector<std::string>());
      EXPECT_EQ(text_of(scene, "Solver/Method"), "auto");
      EXPECT_EQ(scene.get_parameters().solver.method, Method::newton);
      EXPECT_EQ(text_of(scene, "Model/Dilatation"), "auto");
      EXPECT_TRUE(scene.get_parameters().model.has_patches());
    }

    TEST(SceneFile, AnInterpolationDecidesImportanceAndWeights)
    {
      const std::string interpolation = "set Scene = interpolation\n" + two_poses;
      const SceneFile   scene("", interpolation + "end\n", std::vector<std::string>());
      EXPECT_EQ(text_of(scene, "Examples/Importance"), "1");
      EXPECT_EQ(text_of(scene, "Examples/Weights"), "prescribed");
      EXPECT_EQ(scene.get_parameters().examples.weights, WeightRule::prescribed);
      EXPECT_EQ(refusal_of(interpolation + "set Importance = 1.0\nend\n"), "no UserError");
      expect_contains(
          refusal_of(interpolation + "set Importance = 0.5\nend\n"),
          "a.prm:5: Examples/Importance = 0.5, but an interpolation has Importance = 1");
    }

    TEST(SceneFile, ReferenceHasASampleOfEachNamedSubsection)
    {
      std::set<std::string> paths;
      for (const DeclaredKey &key : SceneFile::reference())
        paths.insert(key.path());
      for (const char *path :
           { "Scene", "Handles/NAME/Motion", "Loads/NAME/Force", "Material/region 1/Density" })
        EXPECT_EQ(paths.count(path), 1u) << path;
    }
  } // namespace
} // namespace Exemplar::Testing
