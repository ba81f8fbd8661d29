# What is kept at the top level is what is meant to be there, and nothing that a compiler made is kept anywhere.
cd "$SRC"
git rev-parse --git-dir > /dev/null 2>&1 || { echo "not a clone"; exit 77; }
git ls-files | sed 's|/.*|/|' | LC_ALL=C sort -u
git ls-files -z | LC_ALL=C xargs -0 grep -la "$(printf '^\177ELF')" | sed 's/^/a program: /'
