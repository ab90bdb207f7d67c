// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/text_file.h>
#include <exemplar/base/time_samples.h>
#include <exemplar/mesh/rigid_motion.h>
#include <exemplar/obstacles/rigid_track.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    constexpr std::size_t n_of_vectors = 7, n_of_matrix = 13; ///< numbers of a line

    Matrix3<double>
    matrix_in(const std::vector<double> &n)
    {
      Matrix3<double> R{};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          R[i][j] = n[1 + 4 * i + j];
      return R;
    }

    /// What keeps a matrix from being a rotation; empty: nothing.
    std::string
    fault_of_rotation(const Matrix3<double> &R)
    {
      const Matrix3<double> C = transpose_times(R, R);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          if (!(std::abs(C[i][j] - (i == j ? 1. : 0.)) < 1e-4))
            return "its matrix R stretches. Only rotations are rigid";
      return determinant(R) < 0. ? "its matrix R mirrors. Only rotations are rigid" : "";
    }

    /// What is wrong with a line of numbers, of which the one before has `n_wanted` and an earlier time; empty: nothing.
    std::string
    fault_of_line(const std::vector<double> &n, const std::size_t n_wanted, const double before)
    {
      if (n.size() != n_wanted || (n.size() != n_of_vectors && n.size() != n_of_matrix))
        return fmt::format("it has {} numbers. Allowed: 7, t and a displacement and a rotation "
                           "vector [rad], or 13, t and three rows of (R p), the same in all lines",
                           n.size());
      if (!std::all_of(n.begin(), n.end(), [](const double x) { return std::isfinite(x); }))
        return "all of it must be finite numbers";
      if (!(n[0] > before))
        return "t must be later than in the line before";
      return n.size() == n_of_matrix ? fault_of_rotation(matrix_in(n)) : "";
    }

    /// The frame of a line with a matrix, with a rotation vector that is near that of the frame before.
    RigidTrack::Frame
    frame_of_matrix(const std::vector<double> &n, const RigidTrack::Frame &before)
    {
      const AxisAngle      turn = axis_and_angle(matrix_in(n));
      dealii::Tensor<1, 3> last, vector = turn.angle * turn.axis;
      for (unsigned int c = 0; c < 3; ++c)
        last[c] = before[3 + c];
      const dealii::Tensor<1, 3> axis = turn.angle > 0.    ? turn.axis
                                        : last.norm() > 0. ? last / last.norm()
                                                           : last;
      const double               whole_turns
          = std::round((last * axis - turn.angle) / (2. * dealii::numbers::PI));
      vector += 2. * dealii::numbers::PI * whole_turns * axis;
      return { { n[4], n[8], n[12], vector[0], vector[1], vector[2] } };
    }
  } // namespace

  RigidTrack::Frame
  RigidTrack::at(const double time) const
  {
    const auto [before, next, share] = samples_around(times, time);
    Frame result;
    for (unsigned int i = 0; i < result.size(); ++i)
      result[i] = (1. - share) * frames[before][i] + share * frames[next][i];
    return result;
  }

  RigidTrack
  read_rigid_track(const std::filesystem::path &file)
  {
    require_file(file,
                 "a track: lines of t, a displacement and a rotation vector, or of t and a matrix");
    std::string reason;
    const auto  text = read_text_file(file, &reason);
    if (!text)
      throw UserError(file.string() + " cannot be read: " + reason + ".");
    RigidTrack         track;
    std::istringstream lines(*text);
    std::size_t        n_wanted = 0;
    unsigned int       number   = 0;
    for (std::string line; std::getline(lines, line);)
    {
      ++number;
      line.resize(std::min(line.find('#'), line.size()));
      std::replace(line.begin(), line.end(), ',', ' ');
      std::istringstream  words(line);
      std::vector<double> n;
      for (std::string word; words >> word;)
        n.push_back(parse_number(word));
      if (n.empty())
        continue;
      const bool is_first = track.times.empty();
      n_wanted            = is_first ? n.size() : n_wanted;
      if (const std::string fault
          = fault_of_line(n, n_wanted,
                          is_first ? -std::numeric_limits<double>::infinity() : track.times.back());
          !fault.empty())
        throw UserError(fmt::format("{}:{}: {}.", file.string(), number, fault));
      track.is_of_space = n.size() == n_of_matrix;
      track.frames.push_back(
          track.is_of_space
              ? frame_of_matrix(n, is_first ? RigidTrack::Frame{} : track.frames.back())
              : RigidTrack::Frame{ { n[1], n[2], n[3], n[4], n[5], n[6] } });
      track.times.push_back(n[0]);
    }
    if (track.times.empty())
      throw UserError(file.string()
                      + " has no frame. Give lines of t, a displacement and a rotation vector.");
    return track;
  }
} // namespace Exemplar
