// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/text_file.h>
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

    /// What is wrong with a line of numbers after these times; empty: nothing.
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
      return "";
    }

    /// The rotation of a matrix (R p) after t. Throws std::invalid_argument for one that stretches or mirrors.
    Matrix3<double>
    rotation_of(const std::vector<double> &n)
    {
      Matrix3<double> R{};
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          R[i][j] = n[1 + 4 * i + j];
      const Matrix3<double> C = transpose_times(R, R);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          if (!(std::abs(C[i][j] - (i == j ? 1. : 0.)) < 1e-4))
            throw std::invalid_argument("its matrix R stretches. Only rotations are rigid");
      if (determinant(R) < 0.)
        throw std::invalid_argument("its matrix R mirrors. Only rotations are rigid");
      return R;
    }

    /// The frame of a line with a matrix, with a rotation vector that is near that of the frame before.
    RigidTrack::Frame
    frame_of_matrix(const std::vector<double> &n, const RigidTrack::Frame &before)
    {
      const AxisAngle      turn = axis_and_angle(rotation_of(n));
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
    const auto after = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time)
                                                - times.begin());
    const std::size_t next = std::min(after, times.size() - 1), before = after == 0 ? 0 : after - 1;
    const double      share
        = next > before ? (time - times[before]) / (times[next] - times[before]) : 0.;
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
      n_wanted          = track.times.empty() ? n.size() : n_wanted;
      std::string fault = fault_of_line(
          n, n_wanted,
          track.times.empty() ? -std::numeric_limits<double>::infinity() : track.times.back());
      const bool              is_matrix = n.size() == n_of_matrix;
      const RigidTrack::Frame before
          = track.frames.empty() ? RigidTrack::Frame{} : track.frames.back();
      if (fault.empty())
        try
        {
          track.frames.push_back(is_matrix
                                     ? frame_of_matrix(n, before)
                                     : RigidTrack::Frame{ { n[1], n[2], n[3], n[4], n[5], n[6] } });
        }
        catch (const std::invalid_argument &error)
        {
          fault = error.what();
        }
      if (!fault.empty())
        throw UserError(fmt::format("{}:{}: {}.", file.string(), number, fault));
      track.times.push_back(n[0]);
      track.is_of_space = is_matrix;
    }
    if (track.times.empty())
      throw UserError(file.string()
                      + " has no frame. Give lines of t, a displacement and a rotation vector.");
    return track;
  }
} // namespace Exemplar
