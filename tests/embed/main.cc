// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/exemplar.h>

#include <cmath>
#include <cstdio>

using namespace Exemplar;

// Twists a bar by one end. Its example is the bar twisted, so the example's weight grows.
int
main()
{
  std::vector<dealii::Point<3>> nodes, twisted;
  for (unsigned int i = 0; i < 20; ++i) // 5 x 2 x 2, x fastest
    nodes.emplace_back(i % 5, i / 5 % 2 - 0.5, i / 10 - 0.5);
  for (const auto &p : nodes)
    twisted.emplace_back(p[0], std::cos(p[0] / 4) * p[1] - std::sin(p[0] / 4) * p[2],
                         std::sin(p[0] / 4) * p[1] + std::cos(p[0] / 4) * p[2]);
  std::vector<std::array<unsigned int, 4>> cells; // a brick has six, from its corner 0 to 16
  for (unsigned int a = 0; a < 4; ++a)
    for (const auto &[b, c] :
         { std::pair(1, 6), { 6, 5 }, { 5, 15 }, { 15, 10 }, { 10, 11 }, { 11, 1 } })
      cells.push_back({ { a, a + b, a + c, a + 16 } });

  SceneParameters scene;
  scene.scene          = SceneKind::statics;
  scene.examples.poses = { "twisted" };
  scene.handles
      = { { "left", { "box 0 -1 -1 0 1 1" } },
          { "right", { "box 4 -1 -1 4 1 1" }, "0; cos(t)*y-sin(t)*z-y; sin(t)*y+cos(t)*z-z" } };
  Problem problem(scene, { make_msh(nodes, cells), { { "twisted", twisted } }, {} });
  while (problem.state.step < problem.time_axis.n_steps())
  {
    if (!is_success(problem.advance().status))
      return 1;
    std::printf("%g %.6f %.6f\n", problem.state.time, problem.state.weights[0],
                problem.state.weights[1]);
  }
}
