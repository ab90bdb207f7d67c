// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/exemplar.h>
#include <exemplar/live/keyed_shapes.h>
#include <exemplar/live/rigid_parts.h>
#include <exemplar/mesh/mesh_arrays.h>
#include <exemplar/mesh/rigid_motion.h>
#include <exemplar/surface/shape/triangle_surface.h>
#include <exemplar/surface/shape/vertex_normals.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Exemplar::Live
{
  namespace
  {
    using Point   = dealii::Point<3>;
    using Tensor1 = dealii::Tensor<1, 3>;

    Point
    rounded(const Tensor1 &x)
    {
      Point result;
      for (unsigned int c = 0; c < 3; ++c)
        result[c] = static_cast<double>(static_cast<float>(x[c]));
      return result;
    }

    Places
    rounded(const Places &places)
    {
      Places result;
      for (const Point &x : places)
        result.push_back(rounded(Tensor1(x)));
      return result;
    }

    /// A rigid motion as quaternion and translation.
    ShapeKey
    key_of(const RigidMotion &motion, const ShapeKey *const before)
    {
      ShapeKey key;
      key.rotation
          = quaternion_of(motion.rotation, before != nullptr ? &before->rotation : nullptr);
      const Point origin = motion(Point());
      for (unsigned int c = 0; c < 3; ++c)
        key.translation[c] = static_cast<float>(origin[c]);
      return key;
    }

    Point
    placed(const ShapeKey &key, const Tensor1 &x)
    {
      const Tensor1 axis(
          { double(key.rotation[0]), double(key.rotation[1]), double(key.rotation[2]) });
      const Tensor1 twice = 2. * dealii::cross_product_3d(axis, x);
      Point result(x + double(key.rotation[3]) * twice + dealii::cross_product_3d(axis, twice));
      for (unsigned int c = 0; c < 3; ++c)
        result[c] += double(key.translation[c]);
      return result;
    }

    /// Places turned and moved back by a rigid motion, so that rest is where it was.
    Places
    moved_back(const RigidMotion &motion, const Places &places)
    {
      Places result;
      for (const Point &place : places)
      {
        const Tensor1 y = place - motion.to;
        Point         x = motion.from;
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = 0; j < 3; ++j)
            x[i] += motion.rotation[j][i] * y[j];
        result.push_back(x);
      }
      return result;
    }

    using Triangles = std::vector<std::vector<unsigned int>>;

    /// Triangles of all surfaces, by numbers of vertices in lists of places.
    Triangles
    triangles_of(const std::vector<MovingSurface> &surfaces)
    {
      Triangles triangles;
      for (const MovingSurface &moving : surfaces)
        for (const auto &triangle : triangulate(moving.surface).triangles)
        {
          triangles.emplace_back(triangle.begin(), triangle.end());
          for (unsigned int &vertex : triangles.back())
            vertex += static_cast<unsigned int>(moving.first_in_list);
        }
      return triangles;
    }

    Places
    normals_of(const Triangles &triangles, const Places &places)
    {
      std::vector<SpaceVector> vertices;
      for (const Point &x : places)
        vertices.push_back({ { x[0], x[1], x[2] } });
      Places normals;
      for (const SpaceVector &normal : vertex_normals(triangles, vertices))
        normals.emplace_back(normal[0], normal[1], normal[2]);
      return normals;
    }

    using Rows = dealii::FullMatrix<double>; ///< a frame's places a row

    void
    set_row(Rows &rows, const unsigned int row, const Places &values, const Places &minus)
    {
      for (std::size_t v = 0; v < values.size(); ++v)
        for (unsigned int c = 0; c < 3; ++c)
          rows(row, 3 * v + c) = values[v][c] - minus[v][c];
    }

    void
    add_outer_product(Rows                      &rows,
                      const std::vector<double> &weights,
                      const double               factor,
                      const Places              &target)
    {
      for (unsigned int frame = 0; frame < rows.m(); ++frame)
        for (std::size_t v = 0; v < target.size(); ++v)
          for (unsigned int c = 0; c < 3; ++c)
            rows(frame, 3 * v + c) += factor * weights[frame] * target[v][c];
    }

    /// Length of the longest displacement in all rows.
    double
    longest(const Rows &rows)
    {
      double square = 0.;
      for (unsigned int frame = 0; frame < rows.m(); ++frame)
        for (unsigned int i = 0; i < rows.n(); i += 3)
        {
          const double *const x = &rows(frame, i);
          square                = std::max(square, x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
        }
      return std::sqrt(square);
    }

    /// Eigenvectors of R R^T by descending eigenvalue; those of rounding are left out.
    std::vector<std::vector<double>>
    courses_of(const Rows &rows)
    {
      const unsigned int n = rows.m();
      Rows               gram(n, n), vectors;
      rows.mTmult(gram, rows);
      std::vector<std::vector<double>> courses;
      const double                     trace = gram.trace();
      if (!(trace > 0.))
        return courses;
      dealii::LAPACKFullMatrix<double> matrix(n, n);
      matrix = gram;
      dealii::Vector<double> values;
      matrix.compute_eigenvalues_symmetric(1e-14 * trace, 2. * trace, 0., values, vectors);
      for (unsigned int k = values.size(); k-- > 0;)
      {
        courses.emplace_back(n);
        for (unsigned int frame = 0; frame < n; ++frame)
          courses.back()[frame] = vectors(frame, k);
      }
      return courses;
    }

    /// The target that follows a course best: R^T c / (c c).
    Places
    target_of(const Rows &rows, const std::vector<double> &course)
    {
      double square = 0.;
      for (const double x : course)
        square += x * x;
      dealii::Vector<double> c(course.begin(), course.end()), sum(rows.n());
      rows.Tvmult(sum, c);
      Places target;
      for (unsigned int i = 0; i < sum.size(); i += 3)
        target.emplace_back(Tensor1({ sum[i], sum[i + 1], sum[i + 2] }) / square);
      return target;
    }

    Places
    difference(const Places &a, const Places &b)
    {
      Places result;
      for (std::size_t v = 0; v < a.size(); ++v)
        result.emplace_back(a[v] - b[v]);
      return result;
    }

    /// A target with its weights.
    struct Part
    {
      std::vector<double> course; ///< weights by frame
      Places              target;
      Places              normals; ///< what it adds to normals; empty: none
    };

    /// What is not yet shown by targets, a row a frame.
    struct Remainder
    {
      Rows places, normals; ///< normals: of no size where there are none

      /// The part that follows a course, the best in the least-squares sense.
      Part
      part_of(const std::vector<double> &course) const
      {
        return { course, target_of(places, course),
                 normals.m() > 0 ? target_of(normals, course) : Places() };
      }

      void
      subtract(const Part &part)
      {
        add_outer_product(places, part.course, -1., part.target);
        add_outer_product(normals, part.course, -1., part.normals);
      }
    };

    /// Add a multiple of a target to another one.
    void
    add(Places &sum, const double factor, const Places &target)
    {
      for (std::size_t v = 0; v < target.size(); ++v)
        sum[v] += factor * target[v];
    }

    /// The mean of all frames, whose weight is 1, and singular vectors of what is left, whose
    /// weights are from 0 to 1, as the mean takes over what is needed for that: players clamp
    /// other weights.
    std::vector<Part>
    shapes_of(Remainder &left, const std::optional<unsigned int> &n_shapes, const double tolerance)
    {
      std::vector<Part> parts;
      const auto        are_enough = [&]
      { return n_shapes ? parts.size() >= *n_shapes : longest(left.places) <= tolerance; };
      if (are_enough())
        return parts;
      parts.push_back(left.part_of(std::vector<double>(left.places.m(), 1.)));
      left.subtract(parts.front());
      for (const std::vector<double> &course : courses_of(left.places))
      {
        if (are_enough())
          break;
        parts.push_back(left.part_of(course));
        left.subtract(parts.back());
      }
      for (std::size_t i = 1; i < parts.size(); ++i)
      {
        Part        &part  = parts[i];
        const auto   range = std::minmax_element(part.course.begin(), part.course.end());
        const double least = *range.first, width = *range.second - least;
        add(parts.front().target, least, part.target);
        add(parts.front().normals, least, part.normals);
        for (auto *places : { &part.target, &part.normals })
          for (Point &x : *places)
            x *= width;
        for (double &x : part.course)
          x = (x - least) / width;
      }
      return parts;
    }

    std::vector<double>
    course_of_example(const RunMotion &motion, const std::size_t i)
    {
      std::vector<double> course;
      for (const auto &weights : motion.weights)
        course.push_back(weights[i]);
      return course;
    }

    double
    error_of(const KeyedShapes &shapes, const std::vector<Places> &frames)
    {
      double error = 0.;
      for (std::size_t frame = 0; frame < frames.size(); ++frame)
      {
        const Places shown = shapes.places(frame);
        for (std::size_t v = 0; v < shown.size(); ++v)
          error = std::max(error, shown[v].distance(frames[frame][v]));
      }
      return error;
    }
  } // namespace

  Places
  KeyedShapes::places(const std::size_t frame) const
  {
    Places result;
    for (std::size_t v = 0; v < rest.size(); ++v)
    {
      Tensor1 x = rest[v];
      for (std::size_t i = 0; i < targets.size(); ++i)
        x += double(keys[frame].weights[i]) * targets[i][v];
      result.push_back(placed(keys[frame], x));
    }
    return result;
  }

  KeyedShapes
  keyed_shapes(const RunMotion                   &motion,
               const std::optional<unsigned int> &n_shapes,
               const bool                         with_normals)
  {
    KeyedShapes  shapes;
    const auto   n_of_body = motion.surfaces.front().surface.vertices.size();
    const Places body_at_rest(motion.rest.begin(), motion.rest.begin() + n_of_body);
    const auto   fit = [&](const Places &places) {
      return best_rigid_motion(body_at_rest, { places.begin(), places.begin() + n_of_body });
    };
    shapes.n_examples = motion.examples.size();
    shapes.diagonal   = box_diagonal(body_at_rest);
    shapes.rest       = rounded(motion.rest);

    const unsigned int n_frames = motion.frames.size();
    Remainder          left{ Rows(n_frames, 3 * motion.rest.size()), Rows() };
    const Triangles    triangles = with_normals ? triangles_of(motion.surfaces) : Triangles();
    if (with_normals)
    {
      left.normals.reinit(n_frames, 3 * motion.rest.size());
      shapes.rest_normals = normals_of(triangles, motion.rest);
    }
    for (unsigned int frame = 0; frame < n_frames; ++frame)
    {
      const RigidMotion rigid = fit(motion.frames[frame]);
      const Places      local = moved_back(rigid, motion.frames[frame]);
      shapes.keys.push_back(key_of(rigid, frame > 0 ? &shapes.keys.back() : nullptr));
      set_row(left.places, frame, local, motion.rest);
      if (with_normals)
        set_row(left.normals, frame, normals_of(triangles, local), shapes.rest_normals);
    }
    const auto keep = [&](const Part &part)
    {
      shapes.targets.push_back(rounded(part.target));
      if (with_normals)
        shapes.target_normals.push_back(part.normals);
      for (unsigned int frame = 0; frame < n_frames; ++frame)
        shapes.keys[frame].weights.push_back(static_cast<float>(part.course[frame]));
    };
    for (std::size_t i = 0; i < shapes.n_examples; ++i)
    {
      const Places local = moved_back(fit(motion.examples[i]), motion.examples[i]);
      Part         part{ course_of_example(motion, i), difference(local, motion.rest), {} };
      if (with_normals)
        part.normals = difference(normals_of(triangles, local), shapes.rest_normals);
      left.subtract(part);
      keep(part);
    }
    const double tolerance
        = motion.has_contact ? default_error_in_contact : default_error_of_shapes;
    for (const Part &part : shapes_of(left, n_shapes, tolerance * shapes.diagonal))
      keep(part);
    shapes.error = error_of(shapes, motion.frames);
    return shapes;
  }
} // namespace Exemplar::Live
