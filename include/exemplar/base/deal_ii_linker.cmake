# SPDX-License-Identifier: GPL-3.0-or-later
# deal.II asks for the linker that its packager used, which need not be here (Debian 13: mold): then the compiler's own is taken.
macro(exemplar_choose_linker)
  string(REGEX MATCH "-fuse-ld=([a-z]+)" exemplar_linker_flag "${DEAL_II_LINKER_FLAGS}")
  if(exemplar_linker_flag)
    find_program(EXEMPLAR_DEAL_II_LINKER ld.${CMAKE_MATCH_1})
    if(NOT EXEMPLAR_DEAL_II_LINKER)
      string(REPLACE "${exemplar_linker_flag}" "" DEAL_II_LINKER_FLAGS "${DEAL_II_LINKER_FLAGS}")
      if(TARGET dealii::dealii) # from deal.II 9.5 on
        get_target_property(exemplar_link_options dealii::dealii INTERFACE_LINK_OPTIONS)
        list(REMOVE_ITEM exemplar_link_options "${exemplar_linker_flag}")
        set_target_properties(dealii::dealii PROPERTIES INTERFACE_LINK_OPTIONS "${exemplar_link_options}")
      endif()
    endif()
  endif()
endmacro()
