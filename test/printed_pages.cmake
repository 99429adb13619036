# cmake -DTOOLS=folder -DDOC=folder -P: compares the pages that tools print with those in doc.
foreach(tool effects parameters)
  execute_process(COMMAND ${TOOLS}/${tool} --markdown OUTPUT_VARIABLE printed RESULT_VARIABLE code)
  file(READ ${DOC}/${tool}.md page)
  if(NOT code EQUAL 0 OR NOT printed STREQUAL page)
    message(FATAL_ERROR "doc/${tool}.md is old; `scripts/run ${tool} --markdown > doc/${tool}.md` prints it anew")
  endif()
endforeach()
