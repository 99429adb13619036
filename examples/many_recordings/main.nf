// Estimates from all recordings of a list with Nextflow, and merges the results:
//   nextflow run main.nf --list LIST.csv --results RESULTS --table TABLE.csv --shards 4
// The paths are absolute, because Nextflow runs each process in a folder of its own.
params.shards = 4
run = System.getenv("RUN") ?: "${projectDir}/../../scripts/run"  // RUN: the tools of another build

process shard {
    input:
    val number

    output:
    val number

    script:
    "${run} estimate --manifest ${params.list} --output ${params.results} --shard ${number}/${params.shards} --resume --quiet"
}

process merge {
    input:
    val all

    script:
    "${run} estimate --manifest ${params.list} --output ${params.results} --merge ${params.table}"
}

workflow {
    merge(shard(Channel.of(1..params.shards)).collect())
}
