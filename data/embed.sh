#!/bin/sh
# embed.sh NAME FILE.scene ... [-- NAME FILE.scene ...]: lists of scenes as C, so that a tool finds them
# wherever it is.
echo '#include <stickslip/scene.h>'
while [ $# -gt 0 ]; do
    echo "const ss_shipped_scene $1[] = {"
    shift
    while [ $# -gt 0 ] && [ "$1" != -- ]; do
        printf '{ "%s",\n  "%s",\n' "$(basename "$1" .scene)" "$(sed -n '1s/^# *//p' "$1")"
        sed -e 's/[\\"]/\\&/g' -e 's/.*/  "&\\n"/' "$1"
        echo '},'
        shift
    done
    echo '{ NULL, NULL, NULL } };'
    [ $# -eq 0 ] || shift
done
