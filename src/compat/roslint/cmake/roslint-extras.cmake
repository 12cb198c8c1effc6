# Macros of roslint without effect: sources of other packages are not checked.
foreach(macro roslint_cpp roslint_python roslint_custom roslint_add_test)
  cmake_language(EVAL CODE "macro(${macro})\nendmacro()")
endforeach()
