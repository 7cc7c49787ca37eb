# Real pairs: a folder laid out like the published data set, its clouds simulated. Rows have the kind
# "real"; what is wrong with the folder is said.
include(${CMAKE_CURRENT_LIST_DIR}/expect.cmake)
file(REMOVE_RECURSE ${FOLDER})
set(data "${FOLDER}/data")
set(call ${EXPERIMENTS} run -o ${FOLDER}/result --quick --suite translation,accuracy
    --method default,icp-affine --threads 1)

# `simulate` writes such a folder; its truth lies beside the one row.
expect(0 "" ${AGRICOLMAP} simulate -o "${data}/Sugar Beet 10m" --crop sugar_beet_10m --seed 80001
       --field.width 14 --field.height 14 --ugv.length 6 --geotag.scale 0.02)
# Two errors of the translation and one of the accuracy for each of two methods and two seeds. No
# simulated case was asked for.
expect(0 "12 rows, 12 of them new" ${call} --pairs 2 --published ${data})
file(READ ${FOLDER}/result/rows.csv rows)
set(name "Sugar Beet 10m/ugv")
foreach(seed IN ITEMS 80001 80002)
  foreach(row IN ITEMS "translation,0.05,0" "translation,5,0" "accuracy,0.1,0.1")
    string(REPLACE "translation," "translation,final,${name},${name},real,${seed}," row ${row})
    string(REPLACE "accuracy," "accuracy,final,${name},${name},real,${seed}," row ${row})
    if(NOT rows MATCHES "${row},[^\n]*,default,1,accepted,1,1,1,")
      message(FATAL_ERROR "the default preset fails at ${row}: ${rows}")
    endif()
  endforeach()
endforeach()

# The same call has nothing left to do.
file(SHA256 ${FOLDER}/result/rows.csv before)
expect(0 "0 of them new" ${call} --pairs 2 --published ${data})
file(SHA256 ${FOLDER}/result/rows.csv after)
if(NOT before STREQUAL after)
  message(FATAL_ERROR "the second call added rows")
endif()

# Several folders, beside a simulated field.
set(both ${EXPERIMENTS} run -o ${FOLDER}/both --quick --suite accuracy --method default
    --settings develop --threads 1)
file(COPY "${data}/Sugar Beet 10m/" DESTINATION "${FOLDER}/more/North, 2nd")
expect(0 "3 rows" ${both} --published ${data} --published ${FOLDER}/more --case sugar-beet-10m)
file(READ ${FOLDER}/both/rows.csv rows)
foreach(name IN ITEMS "sugar-beet-10m,simulated" "Sugar Beet 10m/ugv,real" "North- 2nd/ugv,real")
  if(NOT rows MATCHES "${name},80001,0.1,0.1,[^\n]*,default,1,accepted,1,1,1,")
    message(FATAL_ERROR "the row of ${name} is missing: ${rows}")
  endif()
endforeach()
expect(3 "both are the pair" ${both} --published ${data} --published ${data})
expect(2 "has no guesses" ${EXPERIMENTS} run -o ${FOLDER}/paper --suite paper --published ${data})

# Other clouds of the same name must not add to these rows.
file(APPEND "${data}/Sugar Beet 10m/ugv/point_cloud.ply" "more")
expect(3 "choose another --output" ${call} --published ${data})

expect(3 "is no folder" ${call} --published ${FOLDER}/nowhere)
file(MAKE_DIRECTORY ${FOLDER}/empty)
expect(3 "no pair of clouds" ${call} --published ${FOLDER}/empty)
file(WRITE "${data}/Sugar Beet 10m/truth.txt" "1 0 0 1e5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")
expect(3 "beside the drone's map" ${call} --published ${data})
file(REMOVE "${data}/Sugar Beet 10m/truth.txt")
expect(3 "has no truth" ${call} --published ${data})
file(WRITE "${data}/Sugar Beet 10m/ugv/ground_truth.txt" "1 0 0 5 0 1 0 6 0 0 1 7 0.1\n")
expect(3 "13 numbers" ${call} --published ${data})
