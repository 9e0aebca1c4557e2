# The report's page: its modules and Observable Plot in one script, so that `gnomon report` needs no Node.
# npm installs what package-lock.json names, into the build folder, when that changes.
option(GNOMON_REPORT "build the page of `gnomon report` (needs npm)" ON)

set(page ${PROJECT_SOURCE_DIR}/framework/gnomon/report/page)
set(report_home ${GNOMON_HOME}/report)
file(GLOB page_modules CONFIGURE_DEPENDS ${page}/src/*.js)
if(GNOMON_REPORT)
  find_program(NPM npm)
  find_program(NODE NAMES node nodejs)
  if(NOT NPM OR NOT NODE)
    message(FATAL_ERROR "The report's page needs Node and npm, which were not found: install them (Debian: nodejs, npm), or configure with -DGNOMON_REPORT=OFF, and `gnomon report` will say that it has no page.")
  endif()
  set(packages ${PROJECT_BINARY_DIR}/report)
  add_custom_command(OUTPUT ${packages}/installed
    COMMAND ${CMAKE_COMMAND} -E make_directory ${packages}
    COMMAND ${CMAKE_COMMAND} -E copy ${page}/package.json ${page}/package-lock.json ${packages}
    COMMAND ${CMAKE_COMMAND} -E chdir ${packages} ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error
    COMMAND ${CMAKE_COMMAND} -E touch ${packages}/installed
    DEPENDS ${page}/package.json ${page}/package-lock.json COMMENT "Installing the report page's packages" VERBATIM)
  add_custom_command(OUTPUT ${report_home}/report.js
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=${packages}/node_modules ${packages}/node_modules/.bin/esbuild ${page}/src/main.js
            --bundle --minify --format=iife --target=chrome109,firefox113,safari16.4 --legal-comments=none --log-level=warning
            --outfile=${report_home}/report.js
    DEPENDS ${packages}/installed ${page_modules} COMMENT "Bundling the report's page" VERBATIM)
  add_custom_target(gnomon_report_page DEPENDS ${report_home}/report.js)
  gnomon_copy_files(gnomon_report_files ${report_home} ${page} ${page}/page.html ${page}/style.css)
  add_dependencies(gnomon gnomon_report_page gnomon_report_files)
  install(DIRECTORY ${report_home} DESTINATION lib/gnomon)
endif()
