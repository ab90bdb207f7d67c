// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_vtu_pieces_h
#define exemplar_vtu_pieces_h

#include <exemplar/run/frames/frame_writer.h>

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Write the .pvtu that joins the .vtu files of these names, the pieces of a frame.
  void
  write_joint_vtu(const Frame                    &frame,
                  const std::vector<std::string> &pieces,
                  const std::filesystem::path    &file);
} // namespace Exemplar

#endif
