# The program end to end on one small field: rows of suites with and without errors of their own; a
# second call has nothing left to do; what is wrong is said.
include(${CMAKE_CURRENT_LIST_DIR}/expect.cmake)
file(REMOVE_RECURSE ${FOLDER})
set(call ${EXPERIMENTS} run -o ${FOLDER} --quick --settings develop --case sugar-beet-10m
    --suite translation,accuracy,inliers --method default,icp-affine,paper --threads 1)

# Two errors of the translation and one of the accuracy for each of three methods; inliers of the one
# that matches points.
expect(0 "10 rows, 10 of them new" ${call})
file(READ ${FOLDER}/rows.csv rows)
if(NOT rows MATCHES "translation,develop,sugar-beet-10m,sugar-beet-10m,simulated,80001,5,0,[^\n]*,default,1,accepted,1,1,1,")
  message(FATAL_ERROR "the default preset fails from five metres: ${rows}")
endif()
if(NOT rows MATCHES "inliers,develop,sugar-beet-10m[^\n]*,paper,")
  message(FATAL_ERROR "no inliers of the paper's chain: ${rows}")
endif()

file(SHA256 ${FOLDER}/rows.csv before)
expect(0 "10 rows, 0 of them new" ${call})
file(SHA256 ${FOLDER}/rows.csv after)
if(NOT before STREQUAL after)
  message(FATAL_ERROR "the second call added rows")
endif()

# The presets, on pairs with guesses of their own.
expect(0 "2 rows, 2 of them new" ${EXPERIMENTS} run -o ${FOLDER}/paper --quick --suite paper
       --case "other-field-soybean,sugar-beet-10m-*asy" --method default --threads 2)

expect(0 "translation" ${EXPERIMENTS} list suites)
expect(0 "neg-mirrored-none-maize" ${EXPERIMENTS} list cases --suite locate)
expect(0 "icp-affine" ${EXPERIMENTS} list methods)
expect(2 "telepathy" ${EXPERIMENTS} run -o ${FOLDER} --quick --method telepathy)
expect(2 "barley" ${EXPERIMENTS} run -o ${FOLDER} --quick --case barley)
expect(2 "weather" ${EXPERIMENTS} run -o ${FOLDER} --quick --suite weather)
expect(2 "has no settings" ${EXPERIMENTS} run -o ${FOLDER} --suite curves --settings develop)
expect(2 "--uniform" ${EXPERIMENTS} run -o ${FOLDER} --suite joint --uniform)
# The same runs in fields that are not small.
expect(3 "choose another --output" ${EXPERIMENTS} run -o ${FOLDER} --settings develop
       --case sugar-beet-10m --suite accuracy --method default)
