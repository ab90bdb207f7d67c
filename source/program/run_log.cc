// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/message_text.h>
#include <exemplar/base/version.h>
#include <exemplar/program/joint_run.h>
#include <exemplar/program/run_log.h>
#include <exemplar/run/output/run_directory.h>

#include <array>
#include <cerrno>
#include <ctime>
#include <iostream>
#include <stdexcept>
#include <system_error>

namespace Exemplar
{
  namespace
  {
    std::string
    date_and_time()
    {
      const std::time_t    now = std::time(nullptr);
      std::tm              utc{};
      std::array<char, 32> text{};
      std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", gmtime_r(&now, &utc));
      return text.data();
    }
  } // namespace

  RunLog::RunLog(const bool quiet) : processes(JointRun::group()), quiet(quiet) {}

  void
  RunLog::say(const std::string &lines)
  {
    if (!quiet)
      processes.of_root(std::cout) << lines << std::flush;
    note(lines);
  }

  void
  RunLog::warn(const std::string &warning)
  {
    warnings.push_back(warning);
    const std::string line = "Warning: " + message_text(warning) + '\n';
    processes.of_root(std::cerr) << line << std::flush;
    note(line);
  }

  void
  RunLog::warn(const std::vector<std::string> &all)
  {
    for (const std::string &warning : all)
      warn(warning);
  }

  void
  RunLog::note(const std::string &lines)
  {
    waiting += lines;
    if (!file.is_open())
      return;
    errno = 0;
    file << waiting << std::flush;
    if (!file)
      throw std::runtime_error("Cannot write " + path.string() + ": "
                               + std::generic_category().message(errno) + ".");
    waiting.clear();
  }

  void
  RunLog::keep_in(const std::filesystem::path &new_path)
  {
    processes.at_root(
        [&]
        {
          path = new_path;
          const bool is_new
              = !std::filesystem::exists(path) || std::filesystem::file_size(path) == 0;
          file.open(path, std::ios::app);
          waiting.insert(0, (is_new ? RunDirectory::log_mark : "") + "\n" + date_and_time()
                                + ", exemplar " EXEMPLAR_VERSION " (" EXEMPLAR_GIT_REVISION ")\n");
          note("");
        });
  }
} // namespace Exemplar
