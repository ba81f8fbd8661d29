# The library speaks as a library: no message of it names a tool or an option.
cd "$SRC"
grep -rnE '"[^"]*(\bss-[a-z]+|(^|[^-])--[a-z]+)[^"]*"' src || true
