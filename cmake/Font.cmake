# The font of the panels: Noto Sans (fonts-noto-core) where it is, else DejaVu Sans (fonts-dejavu-core). Both have the letters
# of European languages and of transliterations of Akkadian.
find_file(DUBSAR_PANEL_FONT NAMES NotoSans-Regular.ttf DejaVuSans.ttf
  PATHS /usr/share/fonts/truetype/noto /usr/share/fonts/truetype/dejavu
  DOC "TrueType font that is embedded for panels" REQUIRED NO_DEFAULT_PATH)
# That of titles in a gallery: the serif of the same family.
find_file(DUBSAR_TITLE_FONT NAMES NotoSerif-Regular.ttf DejaVuSerif.ttf
  PATHS /usr/share/fonts/truetype/noto /usr/share/fonts/truetype/dejavu
  DOC "TrueType font that is embedded for titles" REQUIRED NO_DEFAULT_PATH)
