# link.sh: source it for  link_tool TOOL OBJECT ...: a tool in this directory, with these objects in it.
link_tool() {
    tool=$1
    shift
    objects="$BUILD/tools/$tool.o"
    for part in $TOOL_PARTS; do objects="$objects $BUILD/tools/$part.o"; done
    # shellcheck disable=SC2086  # lists of flags and files
    $CCLD -o "$tool" $objects "$@" "$BUILD/libstickslip.a" $LIBS
}
