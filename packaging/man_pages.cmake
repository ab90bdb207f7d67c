# SPDX-License-Identifier: GPL-3.0-or-later
# exemplar.1 and a page for each of its commands, exemplar-mesh.1 and so on, of what --help says, by help2man.
# cmake -DPROGRAM=exemplar -DVERSION=... -DHELP2MAN=help2man -DDIRECTORY=... -P man_pages.cmake

# The output of a command that must not fail
function(run variable)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}: ${status}")
  endif()
  set(${variable} "${output}" PARENT_SCOPE)
endfunction()

function(write_page page call others)
  separate_arguments(words UNIX_COMMAND "${call}")
  run(help ${words} --help)
  string(REGEX MATCH "^[^\n]*" what "${help}")
  string(REPLACE ";" "(1), " others "${others}")
  file(WRITE ${DIRECTORY}/${page}.include
       "[NAME]\n${page} \\- ${what}\n\n[SEE ALSO]\n${others}(1);\nREADME.md and the pages of doc, in share/exemplar\n")
  run(text ${HELP2MAN} --no-info --version-string "exemplar ${VERSION}" --include ${DIRECTORY}/${page}.include "${call}")
  string(TOUPPER ${page} title)
  string(REGEX REPLACE "\n\\.TH EXEMPLAR " "\n.TH ${title} " text "${text}")
  file(WRITE ${DIRECTORY}/${page}.1 "${text}")
  file(REMOVE ${DIRECTORY}/${page}.include)
endfunction()

run(help ${PROGRAM} --help)
string(REGEX REPLACE ".*\nSubcommands:\n" "" commands "${help}")
string(REGEX REPLACE "\n\n.*" "" commands "${commands}")
string(REGEX MATCHALL "  [a-z]+ [^\n]*" commands "${commands}")
list(TRANSFORM commands REPLACE "^  ([a-z]+) .*" "\\1")
set(pages ${commands})
list(TRANSFORM pages PREPEND exemplar-)
write_page(exemplar ${PROGRAM} "${pages}")
foreach(command page IN ZIP_LISTS commands pages)
  write_page(${page} "${PROGRAM} ${command}" exemplar)
endforeach()
