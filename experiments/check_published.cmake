# The comparison on real pairs: a folder laid out like the published data set, its clouds simulated.
# Rows, tables and page have the kind "real"; what is wrong with the folder is said.
file(REMOVE_RECURSE ${FOLDER})
set(data "${FOLDER}/data")
set(call ${COMPARE} -o ${FOLDER}/result --quick --experiments translation,accuracy
    --methods default,icp-affine --jobs 2)

function(expect expected message)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE text ERROR_VARIABLE text)
  if(NOT code EQUAL expected)
    message(FATAL_ERROR "${ARGN}: ends with ${code}, not ${expected}: ${text}")
  endif()
  string(FIND "${text}" "${message}" place)
  if(place LESS 0)
    message(FATAL_ERROR "${ARGN}: does not say '${message}': ${text}")
  endif()
endfunction()

# `simulate` writes such a folder; its truth lies beside the one row.
expect(0 "" ${AGRICOLMAP} simulate -o "${data}/Sugar Beet 10m" --crop sugar_beet_10m --seed 80001
       --field.width 14 --field.height 14 --ugv.length 6 --geotag.scale 0.02)
expect(0 "" ${call} --pairs 2 --dataset ${data})
file(STRINGS ${FOLDER}/result/rows.csv rows)
list(LENGTH rows lines)
# Two lines of head; two settings of the translation and one of the accuracy for each of two methods
# and two seeds. No simulated data set was asked for.
if(NOT lines EQUAL 14)
  message(FATAL_ERROR "rows.csv has ${lines} lines")
endif()
foreach(seed IN ITEMS 80001 80002)
  foreach(row IN ITEMS "translation,0,0.05,${seed}" "translation,0,5,${seed}" "accuracy,0.1,0.1,${seed}")
    string(FIND "${rows}" "Sugar Beet 10m/ugv,real,${row},default,accepted,1,1," place)
    if(place LESS 0)
      message(FATAL_ERROR "the default preset fails at ${row}: ${rows}")
    endif()
  endforeach()
endforeach()
if(NOT rows MATCHES "# agricolmap_compare [^;]*real data [0-9a-f]+")
  message(FATAL_ERROR "rows.csv does not say which real data: ${rows}")
endif()
file(READ ${FOLDER}/result/success_translation.csv table)
if(NOT table MATCHES "real,Sugar Beet 10m/ugv,0,5,default,2,2,")
  message(FATAL_ERROR "success_translation.csv lacks the real pair: ${table}")
endif()
file(READ ${FOLDER}/result/comparison.html page)
foreach(text IN ITEMS "Sugar Beet 10m/ugv (real)" "scale error 0 %, real" "Real data sets are one pair"
        "paper, real data: 0.05 m / 0.09°")
  string(FIND "${page}" "${text}" place)
  if(place LESS 0)
    message(FATAL_ERROR "the page lacks ${text}")
  endif()
endforeach()

# The same call has nothing left to do.
file(SHA256 ${FOLDER}/result/rows.csv before)
expect(0 "" ${call} --pairs 2 --dataset ${data})
file(SHA256 ${FOLDER}/result/rows.csv after)
if(NOT before STREQUAL after)
  message(FATAL_ERROR "the second call added rows")
endif()

# Several folders, beside a simulated data set.
set(both ${COMPARE} -o ${FOLDER}/both --quick --experiments accuracy --methods default)
file(COPY "${data}/Sugar Beet 10m/" DESTINATION "${FOLDER}/more/North, 2nd")
expect(0 "" ${both} --dataset ${data} --dataset ${FOLDER}/more --datasets sugar-beet-10m)
file(STRINGS ${FOLDER}/both/rows.csv rows)
foreach(name IN ITEMS "sugar-beet-10m,simulated" "Sugar Beet 10m/ugv,real" "North- 2nd/ugv,real")
  string(FIND "${rows}" "${name},accuracy,0.1,0.1,80001,default,accepted,1,1," place)
  if(place LESS 0)
    message(FATAL_ERROR "the row of ${name} is missing: ${rows}")
  endif()
endforeach()
expect(3 "both are the pair" ${both} --dataset ${data} --dataset ${data})

# Other clouds of the same name must not add to these rows.
file(APPEND "${data}/Sugar Beet 10m/ugv/point_cloud.ply" "more")
expect(3 "choose another --output" ${call} --dataset ${data})

expect(3 "is no folder" ${call} --dataset ${FOLDER}/nowhere)
file(MAKE_DIRECTORY ${FOLDER}/empty)
expect(3 "no pair of clouds" ${call} --dataset ${FOLDER}/empty)
file(WRITE "${data}/Sugar Beet 10m/truth.txt" "1 0 0 1e5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")
expect(3 "beside the drone's map" ${call} --dataset ${data})
file(REMOVE "${data}/Sugar Beet 10m/truth.txt")
expect(3 "has no truth" ${call} --dataset ${data})
file(WRITE "${data}/Sugar Beet 10m/ugv/ground_truth.txt" "1 0 0 5 0 1 0 6 0 0 1 7 0.1\n")
expect(3 "13 numbers" ${call} --dataset ${data})
