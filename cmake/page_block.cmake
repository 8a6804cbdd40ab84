# page_with_block(RESULT PAGE COMMAND END CONTENT): a page's text with CONTENT between `<!-- COMMAND -->` and `<!-- END -->`.
function(page_with_block result page command end content)
  file(READ "${page}" text)
  string(FIND "${text}" "<!-- ${command} -->\n" first)
  string(FIND "${text}" "<!-- ${end} -->" last)
  if(first EQUAL -1 OR last LESS first)
    message(FATAL_ERROR "${page} has no block from <!-- ${command} --> to <!-- ${end} -->")
  endif()
  string(SUBSTRING "${text}" 0 ${first} before)
  string(SUBSTRING "${text}" ${last} -1 after)
  set(${result} "${before}<!-- ${command} -->\n\n${content}\n${after}" PARENT_SCOPE)
endfunction()

# write_block(PAGE COMMAND END CONTENT) replaces that block.
function(write_block page command end content)
  page_with_block(text "${page}" "${command}" "${end}" "${content}")
  file(WRITE "${page}" "${text}")
endfunction()
