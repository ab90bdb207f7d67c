// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_shell_kernels_h
#define exemplar_shell_kernels_h

#include <exemplar/kernels/example_arrays.h>
#include <exemplar/kernels/triangle_strain.h>

#include <cstddef>

// The loops over the hinges and triangles of a shell, compiled for several instruction sets. No deal.II header here: see
// matrix3.h.

namespace Exemplar
{
  /// Where numbers of a triangle at rest stand among those of TriangleTask::rest.
  namespace TriangleNumber
  {
    enum : std::size_t
    {
      gradients = 0,  ///< of vertex a along axis j: 2 a + j
      bending   = 6,  ///< of edge i: 3 i + k
      lengths   = 15, ///< of edges
      of_hinge  = 18, ///< of the turn at edge i by the change of its hinge's angle
      of_slope  = 21, ///< and by its slope
      lambda    = 24,
      mu        = 25,
      volume    = 26,
      size      = 27
    };
  } // namespace TriangleNumber

  /// Where numbers stand among those of TriangleTask::found.
  namespace TriangleResult
  {
    enum : std::size_t
    {
      forces  = 0, ///< of membranes at vertex a: 3 a + c [N]
      moments = 9, ///< at the edges [N m]
      scale
      = 12, ///< of the stresses of which forces are differences, times the volume: of the membrane
      bending_scale  = 13, ///< and of what bends
      energy         = 14,
      energy_elastic = 15,
      energy_damping = 16,
      stress_square  = 17,
      size           = 18
    };
  } // namespace TriangleResult

  /// Hinges, by batch as batch_index() says; behind the last one are copies.
  struct HingeTask
  {
    const double       *positions; ///< by degree of freedom
    const unsigned int *nodes;     ///< four
    const double       *rest;      ///< angles
    const double       *last;      ///< angles, of which those found are on the nearest branch
    double             *changes;   ///< found: of the angles
    double             *forms;     ///< found: HingeForm, number 3 i + c
    double             *lengths;   ///< found: of the vectors of that
  };

  /// Triangles, by batch alike.
  struct TriangleTask
  {
    ShellKind           kind;
    std::size_t         n;         ///< number of triangles
    const double       *positions; ///< by degree of freedom
    const unsigned int *nodes;     ///< three
    const unsigned int *hinges;    ///< three, any with a factor 0 where there is none
    const unsigned int *slopes;    ///< three degrees of freedom, alike
    const double       *rest;      ///< TriangleNumber
    const double       *changes;   ///< of hinges' angles
    double              damping;   ///< s
    const double       *past;      ///< six numbers; null without damping
    ExampleArrays       examples;  ///< six numbers of each
    const double       *weights;   ///< of examples
    double             *strains;   ///< six: found by find_strains(), taken by the others
    double             *targets;   ///< six: found by blend(), taken by find_forces()
    double             *areas;     ///< found: over those at rest
    double             *frames;    ///< found: the turned axes, number 3 a + c; null: not wanted
    double             *found;     ///< TriangleResult
    double             *products;  ///< one an example: found by find_products()
  };

  struct ShellKernels
  {
    void (*find_hinges)(const HingeTask &, std::size_t begin, std::size_t end);
    void (*find_strains)(const TriangleTask &, std::size_t begin, std::size_t end);
    void (*blend)(const TriangleTask &, std::size_t begin, std::size_t end);

    /// Volume times the product of each example's strain with the stress of the strain, less that of targets unless `of_strain_alone`.
    void (*find_products)(const TriangleTask &,
                          bool        of_strain_alone,
                          std::size_t begin,
                          std::size_t end);

    void (*find_forces)(const TriangleTask &, std::size_t begin, std::size_t end);
  };

  /// The kernels of the best instruction set that this CPU has.
  const ShellKernels &
  shell_kernels();
} // namespace Exemplar

#endif
