# Headers of the messages made here are found by programs in C++ whose package does not ask for them, as when they lie
# with all others in one folder.
case ":${CPLUS_INCLUDE_PATH:-}:" in
    *":$CATKIN_ENV_HOOK_WORKSPACE/include:"*) ;;
    *) export CPLUS_INCLUDE_PATH="$CATKIN_ENV_HOOK_WORKSPACE/include${CPLUS_INCLUDE_PATH:+:$CPLUS_INCLUDE_PATH}" ;;
esac
