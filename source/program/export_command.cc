// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/standard_streams.h>
#include <exemplar/live/export_page.h>
#include <exemplar/program/export_command.h>

#include <fmt/core.h>

#include <iostream>

namespace Exemplar
{
  void
  write_page(const PageOptions &options)
  {
    const Live::RunPage page = Live::export_page(options.runs, options.html);
    std::cout << fmt::format(
        "{}: {} frames, {:.1f} MB; coordinates are rounded by {:.1e} m at most", options.html,
        page.n_frames, 1e-6 * page.html.size(), page.error)
              << std::endl;
    require_printed();
  }
} // namespace Exemplar
