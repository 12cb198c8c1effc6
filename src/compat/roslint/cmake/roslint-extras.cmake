# What packages call while they are configured; the sources of others are not checked here.
foreach(macro roslint_cpp roslint_python roslint_custom roslint_add_test)
  cmake_language(EVAL CODE "macro(${macro})\nendmacro()")
endforeach()
