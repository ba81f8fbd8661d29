#!/bin/sh
# site.sh PAGE...: the manual as a site of plain HTML, into $OUT: one index, all pages, the pictures.
#
# mandoc makes the pages and the links between them; pages of other programs lead to Debian's.
set -eu
: "${OUT:=build/site}"
others=https://manpages.debian.org/%N.%S
command -v mandoc > /dev/null || { echo "site.sh: mandoc is missing; it makes the pages" >&2; exit 1; }

rm -rf "$OUT"
mkdir -p "$OUT/figures"
cp data/site.css "$OUT/style.css"
cp man/figures/*.png "$OUT/figures"
cp "$@" "$OUT"                          # mandoc links to pages that lie beside the one it makes
(
    cd "$OUT"
    for page in *.[1-9]; do
        mandoc -T html -O "style=style.css,man=%N.%S.html;$others" "$page" |
            sed 's|<body>|<body><p class="home"><a href="index.html">libstickslip</a></p>|' > "$page.html"
    done
    rm ./*.[1-9]
)

# The rows of a section: name and what it is, as .Nd says.
rows() {        # SECTION PAGE...
    section=$1
    shift
    for page; do
        name=${page##*/}
        [ "${name##*.}" = "$section" ] || continue
        printf '<tr><td><a href="%s.html">%s</a></td><td>%s</td></tr>\n' "$name" "${name%.*}" \
            "$(sed -n 's/^\.Nd //p' "$page" | sed 's/&/\&amp;/g; s/</\&lt;/g')"
    done
}

# The pictures of README.md with its words: beside a picture, or two lines above it in a table.
figures() {
    awk '/!\[/ {
        cells = split($0, cell, "|"); split(above, head, "|")
        for (i = 1; i <= cells; i++)
            if (match(cell[i], /man\/figures\/[^)]*/)) {
                file = substr(cell[i], RSTART + 4, RLENGTH - 4)
                match(cell[i], /\[.*\]/)
                words = RLENGTH > 2 ? substr(cell[i], RSTART + 1, RLENGTH - 2) : head[i]
                gsub(/`/, "", words); gsub(/^ *| *$/, "", words)
                printf "<figure><img src=\"%s\" alt=\"%s\"><figcaption>%s</figcaption></figure>\n", file, words, words
            }
    }
    { above = line; line = $0 }' README.md
}

{
    cat << HEAD
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<link rel="stylesheet" href="style.css">
<title>libstickslip $VERSION</title>
</head>
<body>
<h1>libstickslip $VERSION</h1>
<p>A C library and Unix programs that read dry friction from vibration signals: they simulate oscillators that stick and
slip, compute Morlet wavelet coefficients, draw their contours, and measure the contact, with standard errors.
Begin with <a href="stickslip.7.html">stickslip(7)</a>.</p>
HEAD
    for section in 1:Programs 5:Files 7:'Methods and truth' 3:Library; do
        printf '<h2>%s</h2>\n<table>\n' "${section#*:}"
        rows "${section%%:*}" "$@"
        echo '</table>'
    done
    echo '<h2>Pictures</h2>'
    figures
    printf '</body>\n</html>\n'
} > "$OUT/index.html"
