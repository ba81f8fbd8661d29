#!/bin/sh
# embed.sh FILE.scene ...: the shipped scenes as C, so that a tool finds them wherever it is.
echo '#include <stickslip/scene.h>'
echo 'const ss_shipped_scene ss_shipped_scenes[] = {'
for f; do
    printf '{ "%s",\n  "%s",\n' "$(basename "$f" .scene)" "$(sed -n '1s/^# *//p' "$f")"
    sed -e 's/[\\"]/\\&/g' -e 's/.*/  "&\\n"/' "$f"
    echo '},'
done
echo '{ NULL, NULL, NULL } };'
